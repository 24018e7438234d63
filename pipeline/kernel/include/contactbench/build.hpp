// Builds the hierarchy: orders the facets into blocks of eight and bounds every subtree.
//
// Contract: `normalised` are the vertices about Frame::centre over Frame::scale. O(n log n); allocates.
// The order depends on exact IEEE operations alone, so equal input gives equal bytes everywhere.
#pragma once

#include <numeric>
#include <span>
#include <utility>

#include "hierarchy.hpp"

namespace contactbench {

// The facet with its lowest vertex number first, winding kept.
inline Triangle lowest_first(const Triangle& t) {
    const std::size_t i = std::size_t(std::min_element(t.begin(), t.end()) - t.begin());
    return {t[i], t[(i + 1) % 3], t[(i + 2) % 3]};
}

namespace detail {

// As many steps as reach at least so far, as they will be read.
inline std::uint8_t steps_to(double reach, float step) {
    int n = std::clamp(int(std::ceil(reach / double(step))), 0, 255);
    while (n < 255 && double(float(n) * step) < reach) ++n;
    return std::uint8_t(n);
}

inline float rounded_up(double x) {
    const float f = float(x);
    return double(f) < x ? std::nextafter(f, std::numeric_limits<float>::max()) : f;
}

// The upper half of a float, rounded up.
inline std::uint16_t upper_half_of(double x) {
    return std::uint16_t((std::bit_cast<std::uint32_t>(rounded_up(x)) + 0xffffu) >> 16);
}

// Of some facets: everything a lane of a node says, before it is rounded to steps.
struct Bound {
    std::array<std::int16_t, 3> centre{};
    std::array<std::int8_t, 3> axis{127, 0, 0};
    std::uint8_t sine = every_normal;
    double half[3] = {}, spread = 0.0, bend = 0.0, bonus = 0.0;
};

class Builder {
public:
    // `normalised` vertices; normals, errors and bonus of each face.
    Builder(const std::vector<Triangle>& faces, const std::vector<Vec3>& normalised,
            const std::vector<Vec3>& normals, const std::vector<MeshError<double>>& errors,
            const std::vector<double>& bonus)
        : faces_(faces), points_(normalised), normals_(normals), errors_(errors), bonus_(bonus) {}

    Hierarchy build() {
        const std::size_t n = faces_.size();
        order_.resize(n);
        std::iota(order_.begin(), order_.end(), 0);
        centroid_.resize(n);
        for (std::size_t f = 0; f < n; ++f)
            centroid_[f] = (1.0 / 3.0) * (points_[std::size_t(faces_[f][0])] +
                                          points_[std::size_t(faces_[f][1])] +
                                          points_[std::size_t(faces_[f][2])]);
        sort_range(0, n, child_capacity((n + lanes - 1) / lanes));
        fit_priors();
        fill_leaves();
        fill_nodes();
        return std::move(out_);
    }

private:
    using Range = std::pair<std::size_t, std::size_t>;

    // How many blocks each child of a node over `blocks` blocks gets: a power of eight, so that all
    // nodes are full but those on the right edge and the root.
    static std::size_t child_capacity(std::size_t blocks) {
        std::size_t capacity = 1;
        while (capacity * lanes < blocks) capacity *= lanes;
        return capacity;
    }

    // Where to halve `blocks` blocks so that both halves are made of whole children.
    static std::size_t middle(std::size_t blocks, std::size_t capacity) {
        return capacity * (((blocks + capacity - 1) / capacity + 1) / 2);
    }

    void sort_range(std::size_t lo, std::size_t hi, std::size_t capacity) {
        const std::size_t blocks = (hi - lo + lanes - 1) / lanes;
        if (blocks <= 1) return;
        if (blocks <= capacity) return sort_range(lo, hi, child_capacity(blocks));
        const std::size_t mid = lo + lanes * middle(blocks, capacity);
        halve(lo, mid, hi);
        sort_range(lo, mid, capacity);
        sort_range(mid, hi, capacity);
    }

    // Along the one of six axes, of place and of normal, that leaves the halves least to be looked at, as far as some tell.
    void halve(std::size_t lo, std::size_t mid, std::size_t hi) {
        constexpr std::size_t enough = 2048;
        std::vector<std::int32_t> some;
        for (std::size_t i = lo, step = (hi - lo) / enough + 1; i < hi; i += step) some.push_back(order_[i]);
        const auto middle = some.begin() + std::ptrdiff_t(some.size() * (mid - lo) / (hi - lo));
        double least = std::numeric_limits<double>::infinity();
        Along best{};
        for (const std::vector<Vec3>* of : {&std::as_const(centroid_), &normals_})
            for (double Vec3::*axis : {&Vec3::x, &Vec3::y, &Vec3::z}) {
                const Along along{of, axis};
                std::nth_element(some.begin(), middle, some.end(), along);
                const double cost = double(mid - lo) * chance({some.begin(), middle}) + double(hi - mid) * chance({middle, some.end()});
                if (cost < least) least = cost, best = along;
            }
        const auto at = [&](std::size_t i) { return order_.begin() + std::ptrdiff_t(i); };
        std::nth_element(at(lo), at(mid), at(hi), best);
    }

    struct Along {
        const std::vector<Vec3>* of = nullptr;
        double Vec3::*axis = nullptr;

        bool operator()(std::int32_t a, std::int32_t b) const {
            const double p = (*of)[std::size_t(a)].*axis, q = (*of)[std::size_t(b)].*axis;
            return p != q ? p < q : a < b;
        }
    };

    // Up to a factor, how likely facets are to be looked at: that a line meets their box, made wider by what a touch's noise
    // and torsion come to, and that it lies within a friction cone of one of their normals.
    double chance(std::span<const std::int32_t> facets) const {
        constexpr double wider = 0.03, cos_friction = 0.6, sin_friction = 0.8;
        constexpr double inf = std::numeric_limits<double>::infinity();
        Vec3 low{inf, inf, inf}, high{-inf, -inf, -inf}, sum;
        for (const std::int32_t f : facets) {
            sum = sum + normals_[std::size_t(f)];
            for (const std::int32_t v : faces_[std::size_t(f)]) widen(points_[std::size_t(v)], low, high);
        }
        const double length = norm(sum);
        double c = length > 1e-9 ? 1.0 : -1.0;  // the least cosine between the mean normal and one of them
        for (const std::int32_t f : facets) c = std::min(c, dot(normals_[std::size_t(f)], sum) / length);
        const double seen = c > -cos_friction ? 1.0 - cos_friction * c + sin_friction * std::sqrt(std::max(1.0 - c * c, 0.0)) : 2.0;
        const Vec3 d = high - low + Vec3{wider, wider, wider};
        return (d.x * d.y + d.y * d.z + d.z * d.x) * seen;
    }

    static void widen(const Vec3& p, Vec3& low, Vec3& high) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }

    void fit_priors() {
        const auto [least, most] = std::minmax_element(bonus_.begin(), bonus_.end());
        // So that 255 steps, as they will be read, reach the largest.
        Priors& p = out_.priors;
        p.least = -rounded_up(-*least);
        p.step = *most > double(p.least) ? rounded_up((*most - double(p.least)) / 255.0 * (1.0 + 1e-6)) : 0.0f;
    }

    std::uint8_t prior_of(double bonus) const {
        const Priors& p = out_.priors;
        int n = p.step > 0.0f ? std::clamp(int((bonus - double(p.least)) / double(p.step)), 0, 255) : 0;
        while (n < 255 && double(float(n) * p.step + p.least) < bonus) ++n;
        return std::uint8_t(n);
    }

    void fill_leaves() {
        const std::size_t blocks = (order_.size() + lanes - 1) / lanes;
        out_.leaves.resize(blocks);
        out_.face.assign(blocks * lanes, -1);
        std::copy(order_.begin(), order_.end(), out_.face.begin());
        for (std::size_t i = 0; i < blocks; ++i) fill_leaf(i);
    }

    void fill_leaf(std::size_t index) {
        Leaf& leaf = out_.leaves[index];
        const auto [lowest, highest] = box_of(index, index + 1);
        const double low[3] = {lowest.x, lowest.y, lowest.z}, high[3] = {highest.x, highest.y, highest.z};
        double widest = 0.0;
        for (int a = 0; a < 3; ++a) {
            leaf.low[a] = -rounded_up(-low[a]);
            widest = std::max(widest, high[a] - double(leaf.low[a]));
        }
        leaf.step = std::max(rounded_up(widest / 65535.0), std::numeric_limits<float>::min());
        each_facet(index, index + 1, [&](std::size_t slot, std::size_t f) {
            const std::size_t l = slot % lanes;
            for (std::size_t c = 0; c < 3; ++c) {
                const Vec3& p = points_[std::size_t(faces_[f][c])];
                const double at[3] = {p.x, p.y, p.z};
                for (int a = 0; a < 3; ++a) {
                    const double steps = std::round((at[a] - double(leaf.low[a])) / double(leaf.step));
                    leaf.corner[c][a][l] = std::uint16_t(std::clamp(steps, 0.0, 65535.0));
                }
            }
            const Vec3& n = normals_[f];
            leaf.normal[0][l] = float(n.x), leaf.normal[1][l] = float(n.y), leaf.normal[2][l] = float(n.z);
            leaf.bonus[l] = prior_of(bonus_[f]);
            leaf.spread = std::max(leaf.spread, rounded_up(errors_[f].spread));
            leaf.bend = std::max(leaf.bend, rounded_up(errors_[f].bend));
        });
    }

    // Level by level: what eight nodes, or leaves, of the level below hold.
    void fill_nodes() {
        std::size_t below = out_.leaves.size(), blocks = 1;  // how many there are, and leaves in each
        out_.nodes.reserve(below / (lanes - 1) + out_.first.size());
        for (std::size_t level = 0; level == 0 || below > 1; ++level, blocks *= lanes) {
            const std::size_t count = (below + lanes - 1) / lanes;
            out_.first[level + 1] = out_.first[level] + std::int32_t(count);
            for (std::size_t i = 0; i < count; ++i) {
                std::vector<Bound> bounds;
                for (std::size_t child = lanes * i; child < std::min(lanes * (i + 1), below); ++child)
                    bounds.push_back(bound_of(child * blocks, std::min((child + 1) * blocks, out_.leaves.size())));
                out_.nodes.push_back(node_of(bounds));
            }
            below = count;
        }
        std::fill(std::find(out_.first.begin() + 1, out_.first.end(), 0), out_.first.end(),
                  std::numeric_limits<std::int32_t>::max());
    }

    Node node_of(const std::vector<Bound>& bounds) const {
        Node n;
        double reach = 0.0, spread = 0.0, bend = 0.0;
        for (const Bound& b : bounds) {
            reach = std::max({reach, b.half[0], b.half[1], b.half[2]});
            spread = std::max(spread, b.spread), bend = std::max(bend, b.bend);
        }
        n.step = std::max(rounded_up(reach / 255.0 * (1.0 + 1e-6)), std::numeric_limits<float>::min());
        n.spread = upper_half_of(spread), n.bend = upper_half_of(bend);
        for (std::size_t l = 0; l < bounds.size(); ++l) {
            const Bound& b = bounds[l];
            for (std::size_t a = 0; a < 3; ++a) {
                n.centre[a][l] = b.centre[a], n.axis[a][l] = b.axis[a];
                n.half[a][l] = steps_to(b.half[a], n.step);
            }
            n.sine[l] = b.sine;
            n.bonus[l] = prior_of(b.bonus);
        }
        for (std::size_t l = bounds.size(); l < lanes; ++l) n.axis[0][l] = 127;  // has a length
        return n;
    }

    // Of the facets in some leaves.
    Bound bound_of(std::size_t first, std::size_t last) const {
        Bound b;
        Vec3 sum;
        b.bonus = -std::numeric_limits<double>::infinity();
        each_facet(first, last, [&](std::size_t, std::size_t f) {
            sum = sum + normals_[f];
            b.spread = std::max(b.spread, errors_[f].spread), b.bend = std::max(b.bend, errors_[f].bend);
            b.bonus = std::max(b.bonus, bonus_[f]);
        });
        fit_cone(first, last, sum, b);
        const auto [lo, hi] = box_of(first, last);
        const double low[3] = {lo.x, lo.y, lo.z}, high[3] = {hi.x, hi.y, hi.z};
        for (std::size_t a = 0; a < 3; ++a) {
            b.centre[a] = std::int16_t(std::clamp(std::round(0.5 * (low[a] + high[a]) * 32767.0), -32767.0, 32767.0));
            const double centre = double(float(b.centre[a]) * per_centre);
            b.half[a] = std::max(high[a] - centre, centre - low[a]) * (1.0 + 1e-6) + 1e-7;
        }
        return b;
    }

    // A cone about the mean direction that holds all normals.
    void fit_cone(std::size_t first, std::size_t last, Vec3 sum, Bound& b) const {
        const double length = norm(sum);
        if (length > 1e-9) {
            const double mean[3] = {sum.x / length, sum.y / length, sum.z / length};
            for (std::size_t a = 0; a < 3; ++a) b.axis[a] = std::int8_t(std::lround(127.0 * mean[a]));
        }
        Vec3 axis{double(b.axis[0]), double(b.axis[1]), double(b.axis[2])};
        axis = (1.0 / norm(axis)) * axis;
        double c = 1.0;
        each_facet(first, last, [&](std::size_t, std::size_t f) { c = std::min(c, dot(normals_[f], axis)); });
        c -= 1e-6;
        const double sine = c > 0.0 ? std::sqrt(1.0 - c * c) + 1e-6 : 1.0;
        b.sine = std::uint8_t(std::min(std::ceil(255.0 * sine), 255.0));
    }

    std::pair<Vec3, Vec3> box_of(std::size_t first, std::size_t last) const {
        constexpr double inf = std::numeric_limits<double>::infinity();
        Vec3 lo{inf, inf, inf}, hi{-inf, -inf, -inf};
        each_corner(first, last, [&](const Vec3& p) { widen(p, lo, hi); });
        return {lo, hi};
    }

    template <class Do>
    void each_facet(std::size_t first, std::size_t last, Do&& act) const {
        for (std::size_t slot = first * lanes; slot < last * lanes; ++slot)
            if (out_.face[slot] >= 0) act(slot, std::size_t(out_.face[slot]));
    }

    template <class Do>
    void each_corner(std::size_t first, std::size_t last, Do&& act) const {
        each_facet(first, last, [&](std::size_t, std::size_t f) {
            for (const std::int32_t v : faces_[f]) act(points_[std::size_t(v)]);
        });
    }

    const std::vector<Triangle>& faces_;
    const std::vector<Vec3>& points_;
    const std::vector<Vec3>& normals_;
    const std::vector<MeshError<double>>& errors_;
    const std::vector<double>& bonus_;
    std::vector<std::int32_t> order_;
    std::vector<Vec3> centroid_;
    Hierarchy out_;
};

}  // namespace detail
}  // namespace contactbench
