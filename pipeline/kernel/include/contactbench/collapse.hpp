// Fewer facets for the same shape: edges are collapsed in the order of their quadric error (Garland and Heckbert, Surface
// Simplification Using Quadric Error Metrics, 1997), then the vertices go where their facets fit the original best.
//
// A step that would open or fold the surface, join it to itself, or turn a facet far from where it began is not done. Whether
// facets cross is looked at in what comes out; where any do, the work is done again without steps that cause it. So what was
// closed, two-manifold and free of crossings stays so, whatever the count; walls that touched may go on touching. Where no
// step is left the result has more facets than asked for.
//
// Contract: about 100 units long, coordinates as exact.hpp wants them, indices in range, no facet without area. Vertices
// of edges with three facets or more stay where they are. O(m log m).
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "crossings.hpp"
#include "surface.hpp"

namespace contactbench {

// Sum of weighted squared distances to planes: p'Ap + 2 b'p + c.
struct Quadric {
    double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0, x = 0, y = 0, z = 0, c = 0;

    // Of n'p + d.
    static Quadric square(Vec3 n, double d, double weight) {
        const Vec3 w = weight * n;
        return {w.x * n.x, w.x * n.y, w.x * n.z, w.y * n.y, w.y * n.z, w.z * n.z, w.x * d, w.y * d, w.z * d, weight * d * d};
    }
    Quadric& operator+=(const Quadric& o) {
        xx += o.xx, xy += o.xy, xz += o.xz, yy += o.yy, yz += o.yz, zz += o.zz, x += o.x, y += o.y, z += o.z, c += o.c;
        return *this;
    }
    double operator()(Vec3 p) const {
        const double ax = xx * p.x + xy * p.y + xz * p.z + 2 * x, ay = xy * p.x + yy * p.y + yz * p.z + 2 * y,
                     az = xz * p.x + yz * p.y + zz * p.z + 2 * z;
        return std::max(0.0, p.x * ax + p.y * ay + p.z * az + c);
    }
    // The point of least error, drawn to `near` where the planes leave it open.
    Vec3 best(Vec3 near) const {
        const double pull = 1e-5 * (xx + yy + zz) + 1e-300;
        const double a = xx + pull, d = yy + pull, f = zz + pull;
        const Vec3 r = {pull * near.x - x, pull * near.y - y, pull * near.z - z};
        // Cholesky; positive definite by the pull.
        const double l11 = std::sqrt(a), l21 = xy / l11, l31 = xz / l11;
        const double l22 = std::sqrt(std::max(d - l21 * l21, pull * 1e-3)), l32 = (yz - l31 * l21) / l22;
        const double l33 = std::sqrt(std::max(f - l31 * l31 - l32 * l32, pull * 1e-3));
        const double u = r.x / l11, v = (r.y - l21 * u) / l22, w = (r.z - l31 * u - l32 * v) / l33;
        const double pz = w / l33, py = (v - l32 * pz) / l22;
        return {(u - l21 * py - l31 * pz) / l11, py, pz};
    }
};

namespace detail {

struct Box {
    Vec3 low, high;
};

inline Box empty_box() {
    constexpr double inf = std::numeric_limits<double>::infinity();
    return {{inf, inf, inf}, {-inf, -inf, -inf}};
}
inline Box both(const Box& p, const Box& q) {
    return {{std::min(p.low.x, q.low.x), std::min(p.low.y, q.low.y), std::min(p.low.z, q.low.z)},
            {std::max(p.high.x, q.high.x), std::max(p.high.y, q.high.y), std::max(p.high.z, q.high.z)}};
}
inline Box box_of(const Vec3& a, const Vec3& b, const Vec3& c) {
    return {{std::min({a.x, b.x, c.x}), std::min({a.y, b.y, c.y}), std::min({a.z, b.z, c.z})},
            {std::max({a.x, b.x, c.x}), std::max({a.y, b.y, c.y}), std::max({a.z, b.z, c.z})}};
}
// What both have in common, and so far around it.
inline Box common(const Box& p, const Box& q, double around) {
    return {{std::max(p.low.x, q.low.x) - around, std::max(p.low.y, q.low.y) - around, std::max(p.low.z, q.low.z) - around},
            {std::min(p.high.x, q.high.x) + around, std::min(p.high.y, q.high.y) + around, std::min(p.high.z, q.high.z) + around}};
}
inline bool apart(const Box& p, const Box& q) {
    return p.low.x > q.high.x || p.low.y > q.high.y || p.low.z > q.high.z || q.low.x > p.high.x || q.low.y > p.high.y || q.low.z > p.high.z;
}

// Which facets are near: each is listed in those cells of a grid that its box and one of those watched meet.
class FacetGrid {
public:
    // `wanted`: the length of a cell's side, exceeded where there would be too many cells.
    FacetGrid(const Box& box, double wanted, const std::vector<Box>& watched) : low_(box.low) {
        const Vec3 d = box.high - box.low;
        const double extent[3] = {d.x, d.y, d.z};
        for (cell_ = std::max(wanted, 1e-9);; cell_ *= 1.25) {
            double cells = 1.0;
            for (double length : extent) cells *= 1.0 + std::floor(length / cell_);
            if (cells <= most_cells_) break;
        }
        for (std::size_t k = 0; k < 3; ++k) count_[k] = 1 + int(extent[k] / cell_);
        first_.assign(std::size_t(count_[0]) * std::size_t(count_[1]) * std::size_t(count_[2]), unwatched_);
        for (const Box& each : watched)
            each_cell(each, [](std::int32_t& first) { return first = -1, true; }, false);
    }

    bool watches(const Box& box) {
        bool any = false;
        each_cell(box, [&](std::int32_t) { return any = true, false; });
        return any;
    }

    void add(std::int32_t facet, const Box& box) {
        each_cell(box, [&](std::int32_t& first) {
            std::int32_t at = free_;
            if (at < 0) at = std::int32_t(entries_.size()), entries_.emplace_back();
            else free_ = entries_[std::size_t(at)].next;
            entries_[std::size_t(at)] = {facet, first};
            first = at;
            return true;
        });
    }

    // With the box that it was added with.
    void remove(std::int32_t facet, const Box& box) {
        each_cell(box, [&](std::int32_t& first) {
            std::int32_t* at = &first;
            while (entries_[std::size_t(*at)].facet != facet) at = &entries_[std::size_t(*at)].next;
            const std::int32_t gone = *at;
            *at = entries_[std::size_t(gone)].next;
            entries_[std::size_t(gone)].next = free_;
            free_ = gone;
            return true;
        });
    }

    // Those near the box, some of them more than once, until `look` says false.
    template <class Look>
    void each_near(const Box& box, Look&& look) {
        each_cell(box, [&](std::int32_t first) {
            for (std::int32_t at = first; at >= 0; at = entries_[std::size_t(at)].next)
                if (!look(entries_[std::size_t(at)].facet)) return false;
            return true;
        });
    }

private:
    static constexpr double most_cells_ = 4e6;
    static constexpr std::int32_t unwatched_ = -2;
    struct Entry {
        std::int32_t facet, next;
    };

    // Of those that are watched, or of all, until `act` says false.
    template <class Do>
    void each_cell(const Box& box, Do&& act, bool watched = true) {
        const Vec3 lo = box.low - low_, hi = box.high - low_;
        const int i0 = index(lo.x, 0), i1 = index(hi.x, 0), j0 = index(lo.y, 1), j1 = index(hi.y, 1), k0 = index(lo.z, 2), k1 = index(hi.z, 2);
        for (int i = i0; i <= i1; ++i)
            for (int j = j0; j <= j1; ++j)
                for (int k = k0; k <= k1; ++k) {
                    std::int32_t& first = first_[(std::size_t(i) * std::size_t(count_[1]) + std::size_t(j)) * std::size_t(count_[2]) + std::size_t(k)];
                    if ((first != unwatched_ || !watched) && !act(first)) return;
                }
    }
    int index(double along, std::size_t axis) const { return int(std::clamp(along / cell_, 0.0, double(count_[axis] - 1))); }

    Vec3 low_;
    double cell_;
    std::array<int, 3> count_;
    std::vector<std::int32_t> first_;
    std::vector<Entry> entries_;
    std::int32_t free_ = -1;
};

}  // namespace detail

class Collapse {
public:
    using Facet = detail::Facet;
    using Box = detail::Box;

    // `groups`: 0 or 1 per facet; `labels`: a facet keeps its own, and the lines between them their course, at the price of
    // the count; `watched`: where no step may let facets meet; those that touched may go on doing so unless `strict`.
    Collapse(std::vector<Vec3> vertices, std::vector<Facet> faces, const std::vector<std::uint8_t>& groups,
             const std::vector<std::int32_t>& labels, std::vector<Box> watched = {}, bool strict = false)
        : v_(std::move(vertices)), f_(std::move(faces)), group_(groups), alive_(f_.size(), true), sliver_(f_.size()), ring_(v_.size()), q_(v_.size()),
          version_(v_.size(), 0), into_(v_.size(), -1), held_(v_.size(), false), border_(v_.size(), false), line_(v_.size(), false), labels_(labels),
          room_(labels.empty() ? 1 : 1 + std::size_t(*std::max_element(labels.begin(), labels.end()))), swept_(room_.size()), began_(f_.size()),
          watched_(std::move(watched)), strict_(strict), looked_(f_.size(), 0) {
        if (!watched_.empty()) grid_ = make_grid();
        for (std::uint8_t g : group_) ++left_[g];
        for (std::size_t f = 0; f < f_.size(); ++f)
            for (std::int32_t v : f_[f]) ring_[std::size_t(v)].push_back(std::int32_t(f));
        for (std::size_t f = 0; f < f_.size(); ++f) {
            const auto& t = f_[f];
            const Vec3 n = normal(t);
            const double doubled = norm(n);
            began_[f] = 1.0 / doubled * n, doubled_ += doubled;
            room_[std::size_t(labels_[f])] += sweep_ * doubled;
            const Quadric plane = square(began_[f], at(t[0]), doubled);
            for (std::int32_t v : t) q_[std::size_t(v)] += plane;
        }
        for (std::size_t f = 0; f < f_.size(); ++f) sliver_[f] = norm(normal(f_[f])) * double(f_.size()) < sliver_share_ * doubled_;
        for (std::size_t f = 0; f < f_.size(); ++f)
            for (std::size_t k = 0; k < 3; ++k) {
                const std::int32_t a = f_[f][k], b = f_[f][(k + 1) % 3];
                int facets = 0, others = 0;
                bool line = false;
                for (std::int32_t g : ring_[std::size_t(a)])
                    if (has(g, b)) {
                        line = line || labels_[std::size_t(g)] != labels_[f];
                        ++facets, others += group_[std::size_t(g)] != group_[f];
                    }
                if (line) line_[std::size_t(a)] = line_[std::size_t(b)] = true;
                if (facets > 2) held_[std::size_t(a)] = held_[std::size_t(b)] = true;
                if (facets == 1) border_[std::size_t(a)] = border_[std::size_t(b)] = true;
                // A rim keeps its course, and so does the line between two groups, or the denser one would grow.
                if (facets > 2 || (facets == 2 && others == 0 && !line)) continue;
                const Vec3 along = at(b) - at(a), across = cross(along, began_[f]);
                const Quadric wall = square(1.0 / norm(across) * across, at(a), (line ? line_weight_ : facets == 1 ? 10.0 : 1.0) * norm2(along));
                q_[std::size_t(a)] += wall, q_[std::size_t(b)] += wall;
            }
    }

    // Goes on until no group has more facets than are wanted of it. `progress` takes the fraction done every few thousand
    // steps, and ends the work by throwing.
    void run(std::array<std::int64_t, 2> wanted, const std::function<void(double)>& progress) {
        wanted_ = wanted;
        draw_samples(std::min({most_samples_, samples_per_original_ * double(f_.size()), samples_per_facet_ * double(wanted[0] + wanted[1])}));
        for (std::size_t f = 0; f < f_.size(); ++f)
            for (std::size_t k = 0; k < 3; ++k) {
                const std::int32_t a = f_[f][k], b = f_[f][(k + 1) % 3];
                if (a < b || at_edge(a, b) == 1) steps_.push(planned(a, b));
            }
        const double all = double(std::max<std::int64_t>(1, left_[0] + left_[1] - wanted[0] - wanted[1]));
        std::int64_t ticks = 0;
        std::vector<Step> refused;
        bool moved = true;
        // What was refused may do later, when its neighbours have changed.
        while (moved && !done()) {
            moved = false;
            Step step;
            while (!done() && steps_.pop(step)) {
                if (into_[std::size_t(step.a)] >= 0 || into_[std::size_t(step.b)] >= 0 || version(step.a, step.b) != step.version) continue;
                if (++ticks % 4096 == 0)
                    progress(std::clamp(1.0 - double(left_[0] + left_[1] - wanted[0] - wanted[1]) / all, 0.0, 1.0));
                if (!needed(step)) continue;
                if (take(step)) moved = true;
                else refused.push_back(step);
            }
            for (const Step& again : refused) steps_.push(again);
            refused.clear();
        }
    }

    // Vertices in turn take the place of least squares over the samples around, each at its place on its facet.
    void fit() {
        for (Sample& s : samples_) assign(s);
        std::vector<std::size_t> first(f_.size() + 1);
        for (const Sample& s : samples_) ++first[std::size_t(s.facet) + 1];
        std::partial_sum(first.begin(), first.end(), first.begin());
        std::vector<Sample> sorted(samples_.size());
        std::vector<std::size_t> next = first;
        for (const Sample& s : samples_) sorted[next[std::size_t(s.facet)]++] = s;
        samples_.swap(sorted);
        for (int sweep = 0; sweep < sweeps_; ++sweep)
            for (std::size_t v = 0; v < v_.size(); ++v)
                if (!ring_[v].empty() && !held_[v] && !border_[v]) improve(std::int32_t(v), first);
    }

    // Whether facets cross or overlap; where they do is appended to `watched`.
    bool crosses(std::vector<Box>& watched) const {
        const auto [vertices, faces, origin] = result();
        const Crossings met = find_crossings(vertices, faces, faces.size());
        for (std::size_t i = 0; i < met.kinds.size(); ++i) {
            if (Meeting(met.kinds[i]) == Meeting::touching) continue;
            Box both[2];
            for (std::size_t k : {0, 1}) {
                const Facet& t = faces[std::size_t(met.pairs[2 * i + k])];
                both[k] = detail::box_of(vertices[std::size_t(t[0])], vertices[std::size_t(t[1])], vertices[std::size_t(t[2])]);
            }
            watched.push_back(detail::common(both[0], both[1], margin_));
        }
        return met.count[0] + met.count[2] > 0 || !met.complete;
    }

    // And which of the facets given each was.
    std::tuple<std::vector<Vec3>, std::vector<Facet>, std::vector<std::int32_t>> result() const {
        std::vector<std::int32_t> number(v_.size(), -1);
        std::vector<Vec3> vertices;
        std::vector<Facet> faces;
        std::vector<std::int32_t> origin;
        for (std::size_t f = 0; f < f_.size(); ++f) {
            if (!alive_[f]) continue;
            origin.push_back(std::int32_t(f));
            Facet t = f_[f];
            for (std::int32_t& v : t) {
                std::int32_t& n = number[std::size_t(v)];
                if (n < 0) n = std::int32_t(vertices.size()), vertices.push_back(at(v));
                v = n;
            }
            faces.push_back(t);
        }
        return {std::move(vertices), std::move(faces), std::move(origin)};
    }

private:
    struct Step {
        double cost;
        std::int32_t a, b;
        std::uint32_t version;  // of both ends together, which only grows
    };
    // Steps in the order of their cost, within an eighth of it alike and then first come, first served: a heap would jump
    // about in memory.
    class Steps {
    public:
        void push(const Step& s) {
            const std::size_t level = std::bit_cast<std::uint32_t>(float(std::clamp(s.cost, 1e-36, 1e36))) >> 20;
            levels_[level].push_back(s);
            lowest_ = std::min(lowest_, level);
        }
        bool pop(Step& s) {
            for (; lowest_ < levels_.size(); ++lowest_) {
                auto& level = levels_[lowest_];
                std::size_t& next = next_[lowest_];
                if (next < level.size()) {
                    s = level[next++];
                    return true;
                }
                std::vector<Step>().swap(level);
                next = 0;
            }
            return false;
        }

    private:
        std::array<std::vector<Step>, 2048> levels_;
        std::array<std::size_t, 2048> next_{};
        std::size_t lowest_ = 2048;
    };
    // A point of the original, the facet that it is nearest to, and the shares of that facet's corners in the nearest point.
    struct Sample {
        Vec3 at, normal;
        std::int32_t facet;
        std::array<double, 3> share;
    };
    static constexpr double line_weight_ = 1000.0;
    static constexpr double sweep_ = 0.04;  // of a label's area: what its lines may sweep, all steps together
    // Cosines: how far one step may turn a facet, and all steps together.
    static constexpr double one_step_ = 0.7, all_steps_ = 0.5;
    static constexpr double sliver_share_ = 0.1, speck_ = 0.05;  // of the mean facet: at first, and later
    static constexpr double most_samples_ = 3e5, samples_per_facet_ = 12.0, samples_per_original_ = 3.0;
    // The samples' weight over that of the planes, which keep a vertex on its edge where few samples do.
    static constexpr double fit_weight_ = 10.0;
    static constexpr double above_ = 0.01;  // a sample to its facet: the square of the distance over twice the area
    static constexpr int sweeps_ = 3;
    static constexpr double margin_ = 1.0;  // around a crossing, where another way may lead to another one

    static Quadric square(Vec3 unit, Vec3 at, double weight) { return Quadric::square(unit, -dot(unit, at), weight); }
    // The vertex that one of the original became part of.
    std::int32_t end_of(std::int32_t v) const {
        while (into_[std::size_t(v)] >= 0) v = into_[std::size_t(v)];
        return v;
    }

    const Vec3& at(std::int32_t v) const { return v_[std::size_t(v)]; }
    Vec3 normal(const Facet& t) const { return cross(at(t[1]) - at(t[0]), at(t[2]) - at(t[0])); }

    // For facets of the size that they now have.
    detail::FacetGrid make_grid() {
        Box all = detail::empty_box();
        double doubled = 0.0;
        gridded_ = 0;
        for (std::size_t f = 0; f < f_.size(); ++f) {
            if (!alive_[f]) continue;
            all = detail::both(all, box(f_[f]));
            doubled += norm(normal(f_[f])), ++gridded_;
        }
        detail::FacetGrid grid(all, 2.0 * std::sqrt(doubled / double(std::max<std::int64_t>(1, gridded_))), watched_);
        for (std::size_t f = 0; f < f_.size(); ++f)
            if (alive_[f]) grid.add(std::int32_t(f), box(f_[f]));
        return grid;
    }

    Box box(const Facet& t) const { return detail::box_of(at(t[0]), at(t[1]), at(t[2])); }

    int at_edge(std::int32_t a, std::int32_t b) const {
        int count = 0;
        for (std::int32_t f : ring_[std::size_t(a)]) count += has(f, b);
        return count;
    }
    bool has(std::int32_t f, std::int32_t v) const {
        const auto& t = f_[std::size_t(f)];
        return t[0] == v || t[1] == v || t[2] == v;
    }

    std::uint32_t version(std::int32_t a, std::int32_t b) const { return version_[std::size_t(a)] + version_[std::size_t(b)]; }

    // Where the edge's ends go, and what it costs.
    std::pair<Vec3, double> placed(std::int32_t a, std::int32_t b) const {
        Quadric q = q_[std::size_t(a)];
        q += q_[std::size_t(b)];
        const Vec3 middle = 0.5 * (at(a) + at(b));
        const double length2 = norm2(at(b) - at(a));
        Vec3 to = q.best(middle);
        // Too far from the edge: the planes are nearly parallel, and their meeting point says nothing.
        if (!finite(to) || norm2(to - middle) > 4.0 * length2) to = middle;
        const bool line = line_[std::size_t(a)] && line_[std::size_t(b)] && on_line(a, b);
        if (line) to = keeping_areas(a, b, to);
        double cost = q(to);
        if (!line) for (const Vec3& other : {at(a), at(b), middle})
            if (const double c = q(other); c < cost) cost = c, to = other;
        // By area alone small parts would go first, however far that moves them. In flat parts the shortest first.
        cost = cost / std::sqrt(std::sqrt(q.xx + q.yy + q.zz)) + 1e-9 * length2;
        return {to, cost};
    }
    // Beside `to`, so that no label loses area where the line between two of them gets a corner less.
    Vec3 keeping_areas(std::int32_t a, std::int32_t b, Vec3 to) const {
        const std::int32_t before = next_on_line(a, b), after = next_on_line(b, a);
        if (before < 0 || after < 0 || before == after) return to;
        Vec3 up{};
        for (std::int32_t f : ring_[std::size_t(a)])
            if (has(f, b)) up = up + normal(f_[std::size_t(f)]);
        const Vec3 from = at(before), chord = at(after) - from, first = at(a) - from, second = at(b) - from;
        const Vec3 aside = cross(chord, up);
        const double off = dot(cross(first, second) + cross(second, chord), up) - dot(to - from, aside);
        const Vec3 moved = to + off / norm2(aside) * aside;
        return finite(moved) && norm2(moved - to) < norm2(at(b) - at(a)) ? moved : to;
    }

    // The other end of the line that comes to `v` from a neighbour; -1: it has several, or none.
    std::int32_t next_on_line(std::int32_t v, std::int32_t from) const {
        std::int32_t found = -1;
        for (std::int32_t f : ring_[std::size_t(v)])
            for (std::int32_t u : f_[std::size_t(f)]) {
                if (u == v || u == from || u == found || !on_line(v, u)) continue;
                if (found >= 0) return -1;
                found = u;
            }
        return found;
    }

    Step planned(std::int32_t a, std::int32_t b) const { return {placed(a, b).second, a, b, version(a, b)}; }

    bool done() const { return left_[0] <= wanted_[0] && left_[1] <= wanted_[1]; }

    // Whether it takes facets only from groups that have too many.
    bool needed(const Step& s) const {
        for (std::int32_t f : ring_[std::size_t(s.a)])
            if (has(f, s.b) && left_[group_[std::size_t(f)]] <= wanted_[group_[std::size_t(f)]]) return false;
        return true;
    }

    bool take(const Step& s) {
        const auto a = std::size_t(s.a), b = std::size_t(s.b);
        if (held_[a] || held_[b] || !keeps_topology(s.a, s.b)) return false;
        kept_.clear(), lost_.clear();
        for (std::size_t end : {a, b})
            for (std::int32_t f : ring_[end]) {
                if (!has(f, std::int32_t(end == a ? b : a))) kept_.push_back(f);
                else if (end == a) lost_.push_back(f);
            }
        const Vec3 to = placed(s.a, s.b).first;
        if (!keeps_shape(s, to) || !keeps_lines(s, to) || (grid_ && meets_others(s, to))) return false;
        for (std::size_t label = 1; label < room_.size(); ++label) room_[label] -= swept_[label];
        if (grid_) {
            for (const auto* some : {&kept_, &lost_})
                for (std::int32_t f : *some) grid_->remove(f, box(f_[std::size_t(f)]));
        }
        v_[a] = to;
        for (std::int32_t f : lost_) {
            alive_[std::size_t(f)] = false;
            --left_[group_[std::size_t(f)]];
            for (std::int32_t v : f_[std::size_t(f)])
                if (v != s.b) {
                    auto& ring = ring_[std::size_t(v)];
                    ring.erase(std::find(ring.begin(), ring.end(), f));
                }
        }
        for (std::int32_t f : ring_[b])
            if (alive_[std::size_t(f)]) {
                auto& t = f_[std::size_t(f)];
                *std::find(t.begin(), t.end(), s.b) = s.a;
                ring_[a].push_back(f);
            }
        std::vector<std::int32_t>().swap(ring_[b]);
        for (std::int32_t f : ring_[a]) {
            const Vec3 n = normal(f_[std::size_t(f)]);
            if (const double size = norm(n); is_speck(f, size)) began_[std::size_t(f)] = 1.0 / size * n;
            if (grid_) grid_->add(f, box(f_[std::size_t(f)]));
        }
        q_[a] += q_[b];
        border_[a] = border_[a] || border_[b];
        line_[a] = line_[a] || line_[b];
        ++version_[a];
        into_[b] = s.a;
        neighbours(s.a, near_);
        if (grid_ && 4 * (left_[0] + left_[1]) < gridded_) grid_ = make_grid();
        for (std::int32_t v : near_) steps_.push(planned(std::min(s.a, v), std::max(s.a, v)));
        return true;
    }

    void neighbours(std::int32_t v, std::vector<std::int32_t>& out) const {
        out.clear();
        for (std::int32_t f : ring_[std::size_t(v)])
            for (std::int32_t u : f_[std::size_t(f)])
                if (u != v) out.push_back(u);
        std::sort(out.begin(), out.end());
        out.erase(std::unique(out.begin(), out.end()), out.end());
    }

    // The ends have no common neighbour but the corners across the edge, or the surface would be pinched (Dey et al. 1999).
    bool keeps_topology(std::int32_t a, std::int32_t b) {
        neighbours(a, near_), neighbours(b, near_b_);
        int common = 0;
        for (std::int32_t v : near_) common += std::binary_search(near_b_.begin(), near_b_.end(), v);
        const int facets = at_edge(a, b);
        if (facets == 0 || common != facets) return false;
        // A tetrahedron is the least.
        if (near_.size() + near_b_.size() - std::size_t(common) - 2 < 3) return false;
        if (border_[std::size_t(a)] && border_[std::size_t(b)] && facets == 2) return false;
        return !(line_[std::size_t(a)] && line_[std::size_t(b)]) || on_line(a, b);
    }

    // Whether the facets at an edge have different labels.
    bool on_line(std::int32_t a, std::int32_t b) const {
        std::int32_t first = -1;
        for (std::int32_t f : ring_[std::size_t(a)]) {
            if (!has(f, b)) continue;
            if (first >= 0 && labels_[std::size_t(f)] != labels_[std::size_t(first)]) return true;
            first = f;
        }
        return false;
    }

    // Whether the lines around every label have room for what the step sweeps, which is then in `swept_`.
    bool keeps_lines(const Step& s, Vec3 to) {
        std::fill(swept_.begin(), swept_.end(), 0.0);
        if (!line_[std::size_t(s.a)] && !line_[std::size_t(s.b)]) return true;
        const auto sweep = [&](std::int32_t f, Vec3 p, Vec3 q) { swept_[std::size_t(labels_[std::size_t(f)])] += norm(cross(p, q)); };
        if (on_line(s.a, s.b))
            for (std::int32_t f : lost_) sweep(f, at(s.a) - to, at(s.b) - to);
        for (std::int32_t end : {s.a, s.b})
            for (std::int32_t f : ring_[std::size_t(end)])
                for (std::int32_t u : f_[std::size_t(f)])
                    if (u != s.a && u != s.b && on_line(end, u)) sweep(f, at(end) - at(u), to - at(u));
        for (std::size_t label = 1; label < room_.size(); ++label)
            if (swept_[label] > room_[label]) return false;
        return true;
    }

    // Spread evenly over the original.
    void draw_samples(double count) {
        double all = 0.0, passed = 0.0;
        for (const Facet& t : f_) all += norm(normal(t));
        const double each = all / count;
        sample_weight_ = fit_weight_ * each;
        for (std::size_t f = 0; f < f_.size(); ++f) {
            const Vec3 &a = at(f_[f][0]), &b = at(f_[f][1]), &c = at(f_[f][2]);
            passed += norm(normal(f_[f]));
            for (double i = double(samples_.size()); (i + 0.5) * each < passed; ++i) {
                // Roberts' sequence fills a square evenly; what lies beyond its diagonal is folded back.
                double u = 0.7548776662466927 * i, w = 0.5698402909980532 * i;
                u -= std::floor(u), w -= std::floor(w);
                if (u + w > 1.0) u = 1.0 - u, w = 1.0 - w;
                samples_.push_back({a + u * (b - a) + w * (c - a), began_[f], std::int32_t(f), {}});
            }
        }
    }

    // Find the nearest facet that faces as the sample does, going from one to its neighbours; without one the sample has no share.
    void assign(Sample& s) {
        if (!alive_[std::size_t(s.facet)]) s.facet = ring_[std::size_t(end_of(f_[std::size_t(s.facet)][0]))].front();
        s.share = {};
        double best = std::numeric_limits<double>::infinity();
        ++look_;
        const auto look = [&](std::int32_t f) {
            if (std::exchange(looked_[std::size_t(f)], look_) == look_) return;
            const Vec3 &a = at(f_[std::size_t(f)][0]), u = at(f_[std::size_t(f)][1]) - a, w = at(f_[std::size_t(f)][2]) - a, n = cross(u, w);
            if (const double along = dot(n, s.normal); !(along > 0.0 && along * along > 0.09 * norm2(n))) return;
            const Vec3 nearest = nearest_on_triangle(s.at, a, a + u, a + w);
            if (const double d = norm2(s.at - nearest); d < best) {
                best = d, s.facet = f;
                const double second = dot(cross(nearest - a, w), n) / norm2(n), third = dot(cross(u, nearest - a), n) / norm2(n);
                s.share = {1.0 - second - third, second, third};
            }
        };
        look(s.facet);
        // Over the inside of its facet, and close: no other is nearer.
        if (std::min({s.share[0], s.share[1], s.share[2]}) > 0.0 && best < above_ * norm(normal(f_[std::size_t(s.facet)]))) return;
        for (std::int32_t from = -1; std::exchange(from, s.facet) != s.facet;)
            for (std::int32_t v : f_[std::size_t(from)])
                for (std::int32_t f : ring_[std::size_t(v)]) look(f);
    }

    void improve(std::int32_t vertex, const std::vector<std::size_t>& first) {
        const auto v = std::size_t(vertex);
        Quadric q = q_[v];
        for (std::int32_t f : ring_[v])
            for (std::size_t i = first[std::size_t(f)]; i < first[std::size_t(f) + 1]; ++i) {
                const Sample& s = samples_[i];
                Vec3 rest = s.at;
                double share = 0.0;
                for (std::size_t k = 0; k < 3; ++k)
                    if (const std::int32_t u = f_[std::size_t(f)][k]; u == vertex) share = s.share[k];
                    else rest = rest - s.share[k] * at(u);
                q += Quadric::square(share * s.normal, -dot(s.normal, rest), sample_weight_);
            }
        const Vec3 from = v_[v];
        Vec3 to = q.best(from);
        if (line_[v]) {  // only off the surface: the line stays where it is
            Vec3 up{};
            for (std::int32_t f : ring_[v]) up = up + normal(f_[std::size_t(f)]);
            to = from + dot(to - from, up) / norm2(up) * up;
        }
        const Step stay{0.0, vertex, vertex, 0};
        kept_ = ring_[v], lost_.clear();
        if (!finite(to) || !keeps_shape(stay, to)) return;
        if (grid_) {
            if (meets_others(stay, to)) return;
            for (std::int32_t f : kept_) grid_->remove(f, box(f_[std::size_t(f)]));
        }
        v_[v] = to;
        if (grid_)
            for (std::int32_t f : kept_) grid_->add(f, box(f_[std::size_t(f)]));
    }

    static double shape(Vec3 a, Vec3 b, Vec3 c) {
        const double edges = norm2(b - a) + norm2(c - b) + norm2(a - c);
        return edges > 0 ? norm(cross(b - a, c - a)) / edges : 0.0;
    }

    bool keeps_shape(const Step& s, Vec3 to) const {
        double worst_before = std::numeric_limits<double>::infinity(), worst_after = worst_before;
        for (std::int32_t f : lost_) worst_before = std::min(worst_before, shape(f));
        for (std::int32_t f : kept_) {
            const auto& t = f_[std::size_t(f)];
            std::array<Vec3, 3> p;
            for (std::size_t k = 0; k < 3; ++k) p[k] = t[k] == s.a || t[k] == s.b ? to : at(t[k]);
            const Vec3 before = normal(t), after = cross(p[1] - p[0], p[2] - p[0]);
            const double size = norm(after);
            if (!(size > 0) || !faces_on(f, before, after, size)) return false;
            worst_before = std::min(worst_before, shape(f)), worst_after = std::min(worst_after, shape(p[0], p[1], p[2]));
        }
        return worst_after > 0.01 || worst_after > 0.5 * worst_before;
    }
    // Whether a facet keeps facing the way it did. What began as a sliver may turn while it is small, but not over: its
    // own way shows nothing of the surface, and would keep what is around from a shape that fits.
    bool faces_on(std::int32_t f, Vec3 before, Vec3 after, double size) const {
        const double turn = dot(before, after);
        return is_speck(f, size) ? turn >= 0.0 : turn >= one_step_ * norm(before) * size && dot(began_[std::size_t(f)], after) >= all_steps_ * size;
    }
    bool is_speck(std::int32_t f, double doubled) const {
        return sliver_[std::size_t(f)] && doubled * double(left_[0] + left_[1]) < speck_ * doubled_;
    }
    double shape(std::int32_t f) const {
        const auto& t = f_[std::size_t(f)];
        return shape(at(t[0]), at(t[1]), at(t[2]));
    }

    // Whether facets that the step would move come to meet any other beyond what they share, where that is watched.
    bool meets_others(const Step& s, Vec3 to) {
        // Moved for trial: facets of both ends are then as they would be.
        const Vec3 from_a = at(s.a), from_b = at(s.b);
        const auto put = [&](Vec3 a, Vec3 b) { v_[std::size_t(s.b)] = b, v_[std::size_t(s.a)] = a; };
        put(to, to);
        const bool met = meet_others(s, [&](const Facet& other) {
            put(from_a, from_b);
            bool touched = false;
            for (const auto* some : {&kept_, &lost_})
                for (std::int32_t f : *some) touched = touched || detail::FacetPair(v_, f_[std::size_t(f)], other).meet() != Meeting::none;
            put(to, to);
            return touched;
        });
        put(from_a, from_b);
        return met;
    }

    template <class Touched>
    bool meet_others(const Step& s, Touched&& touched) {
        moved_.clear(), boxes_.clear();
        Box around = detail::empty_box();
        Vec3 mean{};
        for (std::int32_t f : kept_) {
            Facet t = f_[std::size_t(f)];
            std::replace(t.begin(), t.end(), s.b, s.a);
            moved_.push_back(t), boxes_.push_back(box(t));
            around = detail::both(around, boxes_.back());
            mean = mean + normal(t);
        }
        if (!grid_->watches(around)) return false;
        // Among themselves and with neighbours at a vertex only where the surface bends much; elsewhere they cannot.
        const double size = norm(mean);
        bool bent = false;
        for (const Facet& t : moved_) {
            const Vec3 n = normal(t);
            bent = bent || dot(n, mean) < 0.5 * norm(n) * size;
        }
        for (std::size_t i = 0; i < moved_.size(); ++i) {
            const Facet& t = moved_[i];
            if (!detail::has_area(at(t[0]), at(t[1]), at(t[2]))) return true;
            if (bent)
                for (std::size_t j = 0; j < i; ++j)
                    if (detail::FacetPair(v_, t, moved_[j]).meet() != Meeting::none) return true;
        }
        ++look_;
        bool met = false;
        grid_->each_near(around, [&](std::int32_t g) {
            std::uint32_t& looked = looked_[std::size_t(g)];
            if (looked == look_) return true;
            looked = look_;
            const Facet& o = f_[std::size_t(g)];
            const Box there = box(o);
            if (detail::apart(there, around) || has(g, s.a) || has(g, s.b)) return true;
            for (std::size_t i = 0; i < moved_.size() && !met; ++i) {
                const Facet& t = moved_[i];
                if (detail::apart(there, boxes_[i])) continue;
                if (!bent && (has(g, t[0]) || has(g, t[1]) || has(g, t[2]))) {
                    const Vec3 n = normal(o);
                    if (dot(n, mean) > 0.5 * norm(n) * size) continue;
                }
                const Meeting kind = detail::FacetPair(v_, t, o).meet();
                met = kind != Meeting::none && (strict_ || kind != Meeting::touching || !touched(o));
            }
            return !met;
        });
        return met;
    }

    std::vector<Vec3> v_;
    std::vector<Facet> f_;
    std::vector<std::uint8_t> group_;
    std::vector<bool> alive_, sliver_;
    std::vector<std::vector<std::int32_t>> ring_;
    std::vector<Quadric> q_;
    std::vector<std::uint32_t> version_;
    std::vector<std::int32_t> into_;  // the vertex that one was collapsed into
    std::vector<bool> held_, border_, line_;
    std::vector<std::int32_t> labels_;
    std::vector<double> room_, swept_;  // twice the area that the lines of each label may sweep yet, and that a step sweeps
    std::vector<Vec3> began_;
    std::vector<Sample> samples_;
    double doubled_ = 0.0;  // twice the area
    double sample_weight_ = 0.0;
    std::int64_t gridded_ = 0;  // facets when the grid was made
    std::vector<Box> watched_;
    bool strict_;
    std::optional<detail::FacetGrid> grid_;  // where any are watched
    std::array<std::int64_t, 2> left_{}, wanted_{};
    Steps steps_;
    std::vector<std::int32_t> kept_, lost_, near_, near_b_;
    std::vector<Facet> moved_;
    std::vector<Box> boxes_;
    std::vector<std::uint32_t> looked_;  // when a facet was looked at last
    std::uint32_t look_ = 0;
};

// Vertices, facets, and which of the facets given each was. Soundness is paid for at the end: where facets cross in what
// comes out, it is made again without steps that let facets meet there, in the last try without any such step.
inline auto collapse_soundly(const std::vector<Vec3>& vertices, const std::vector<detail::Facet>& faces, const std::vector<std::uint8_t>& groups,
                             const std::vector<std::int32_t>& labels, std::array<std::int64_t, 2> wanted, const std::function<void(double)>& progress) {
    constexpr int tries = 6;
    constexpr double inf = std::numeric_limits<double>::infinity();
    std::vector<detail::Box> watched;
    for (int number = 1;; ++number) {
        const bool last = number == tries;
        if (last) watched.assign(1, {{-inf, -inf, -inf}, {inf, inf, inf}});
        Collapse work(vertices, faces, groups, labels, watched, last);
        work.run(wanted, progress);
        work.fit();
        if (last || !work.crosses(watched)) return work.result();
    }
}

}  // namespace contactbench
