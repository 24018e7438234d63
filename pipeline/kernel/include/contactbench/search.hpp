// The touch that explains a wrench best: over all facets one by one, or through the hierarchy. Both give the same.
//
// A `Hunt` says what is looked for; the likeliest touch first, then, away from what was found, the next. The first
// descent keeps the bounds of what it opened (`Opened`), and later hunts go on from there.
//
// Contract: exhaust is O(n); search is O(log n) where the wrench is precise against the size of the probe. Nothing
// allocates. Of equal touches the one that is met first is taken, and of those the one on the facet of the lowest number.
#pragma once

#include "answer.hpp"

namespace contactbench {

struct Hunt {
    double cos_friction = 0.0;
    double most_misfit = HUGE_VAL;  // d2 of a touch
    double limit = HUGE_VAL;        // of misfit - follow - max(prior, least_prior)
    double more = 0.0;              // by which later hunts may raise it
    double least_prior = -HUGE_VAL;
    double follow_cost = 0.0, follow_distance = 0.0;
    const Vec3* previous = nullptr;  // S, m
    const Candidate* away = nullptr;  // at another place than each of these, see elsewhere()
    double radius[Answer::capacity];  // m
    double depth = 0.0;               // of the gates, m
    int away_count = 0;
    const Candidate* inside = nullptr;  // at the place of this one, whose own radius is radius[0]
    bool layers = false;                // away from one touch: look also for what else lies at its place, see Layers,
    double rival = -HUGE_VAL;           // unless another place costs less than this: then nobody asks
};

namespace detail {

// Of touches of one key the surface met first counts, then the facet of the lowest number.
struct Rank {
    double key = HUGE_VAL, depth = HUGE_VAL;  // to_tie()
    std::int32_t face = -1;

    auto operator<=>(const Rank&) const = default;
};

// Surfaces at a touch's place that are not its own: steps, and layers too near behind each other to be two places.
struct Layers {
    double variance = 0.0;  // how far off the touch's plane they lie along the force, as likely as they are, m^2
    double height = 0.0;    // of `first` against the force, to_tie() of it over the gates' depth
    Candidate first;        // met before the touch, and as likely; slot < 0: none

    // What explains the wrench with d2 at the place of `touch`. True: it is the one to be met first.
    bool add(const Candidate& touch, double depth, Vec3 point, double d2, std::int32_t face) {
        const Off off = off_plane(touch, point);
        if (d2 > touch.misfit + layer_cost || std::fabs(off.height) <= no_deeper * layer_share * depth + layer_slope * off.along)
            return false;
        variance = std::max(variance, off.height * off.height * std::exp(-0.5 * std::max(0.0, d2 - touch.misfit)));
        const double up = to_tie(off.height / depth);
        if (!(d2 <= touch.misfit + same_misfit) || up < height || (up == height && face > first.face)) return false;
        height = up;
        return true;
    }
};

struct Found {
    double key = HUGE_VAL;
    Rank rank;
    Candidate touch;  // slot < 0: none
    bool layered = false;  // `layers` holds all there are
    Layers layers;

    // Nothing yet, of all that counts.
    void clear(bool layers_too) {
        key = HUGE_VAL, rank = {}, touch.slot = -1;
        layered = layers_too, layers.variance = layers.height = 0.0, layers.first.slot = -1;
    }
};

inline void judge_facet(const Model& m, std::size_t slot, const Query& q, const Hunt& hunt, Found& best) {
    const std::int32_t face = m.tree.face[slot];
    if (!(-dot(m.normals[std::size_t(face)], q.f) >= hunt.cos_friction)) return;
    const Facet facet = m.facet(face);
    const FacetFit fit = fit_facet(facet.corner, facet.normal, facet.error, q);
    if (!(fit.d2 <= hunt.most_misfit)) return;
    const double bonus = m.bonus(face), prior = std::max(bonus, hunt.least_prior);
    double key = fit.d2 - prior;
    if (!(key - hunt.follow_cost <= hunt.limit)) return;
    const Triangle& t = m.faces[std::size_t(face)];
    const auto corner = [&](std::size_t c) { return fit.weight[c] * m.vertices[std::size_t(t[c])]; };
    const Vec3 point = corner(0) + (corner(1) + corner(2));
    double follow = 0.0;
    if (hunt.previous && norm(point - *hunt.previous) <= hunt.follow_distance) follow = hunt.follow_cost;
    key -= follow;
    if (!(key <= hunt.limit)) return;
    const Rank rank{to_tie(key), to_tie(dot((1.0 / m.frame.scale) * (point - m.frame.centre), q.f)), face};
    if (!best.layered && !(rank < best.rank)) return;
    if (hunt.inside && elsewhere(*hunt.inside, hunt.radius[0], hunt.depth, point)) return;
    Candidate* to = &best.touch;
    for (int i = 0; i < hunt.away_count; ++i) {
        if (elsewhere(hunt.away[i], hunt.radius[i], hunt.depth, point)) continue;
        if (!best.layered || !best.layers.add(hunt.away[0], hunt.depth, point, fit.d2, face)) return;
        to = &best.layers.first;
    }
    if (to == &best.touch) {
        best.layered = best.layered && fit.d2 - bonus - follow > hunt.rival;
        if (!(rank < best.rank)) return;
        best.key = key, best.rank = rank;
    }
    Candidate& c = *to;
    c = Candidate{};
    c.point = point;
    c.normal = facet.normal;
    c.cosine = fit.cosine;
    c.misfit = fit.d2;
    c.torque = fit.torsion * q.force * m.frame.scale;
    c.prior = bonus;
    c.follow = follow;
    c.face = face;
    c.slot = std::int32_t(slot);
    c.region = m.region(face);
    for (std::size_t i = 0; i < 3; ++i)
        if (fit.weight[i] >= 1.0 - tie) c.vertex = t[i];
}

// What is near a touch, in the search's own numbers: see elsewhere().
struct Near {
    float x, y, z, sx, sy, sz;  // centre and slope, normalised
    float nx, ny, nz;           // normal
    float inner, outer;         // radii less and more what rounding may do
    float flat, tilt;           // off the touch's plane no further than flat + tilt * in it: not another place
    float own, lean;            // no further than own + lean * in it: no other layer
};

inline Near near_point(const Model& m, Vec3 centre, double radius) {
    const Vec3 c = (1.0 / m.frame.scale) * (centre - m.frame.centre);
    const float r = float(radius / m.frame.scale);
    Near near{};
    near.x = float(c.x), near.y = float(c.y), near.z = float(c.z);
    near.inner = std::max(r * (1.0f - 1e-5f) - 2.0f * slack, 0.0f), near.outer = r * (1.0f + 1e-5f) + 2.0f * slack;
    return near;
}

inline Near near_touch(const Model& m, const Candidate& c, double radius, double same_depth) {
    Near near = near_point(m, c.point, radius);
    near.sx = float(c.slope.x), near.sy = float(c.slope.y), near.sz = float(c.slope.z);
    near.nx = float(c.normal.x), near.ny = float(c.normal.y), near.nz = float(c.normal.z);
    const auto least = [&](double depth) {
        return std::max(float(depth * c.cosine / m.frame.scale) * (1.0f - 1e-5f) - 2.0f * slack, 0.0f);
    };
    near.flat = same_depth > 0.0 ? least(same_depth) : HUGE_VALF, near.tilt = float(same_touch_slope) * (1.0f - 1e-4f);
    near.own = least(layer_share * same_depth), near.lean = float(layer_slope) * (1.0f - 1e-4f);
    return near;
}

inline float beyond_rounding(double x) { return x < 1e30 ? float(x + 1e-6 * std::fabs(x) + 1e-6) : 1e30f; }

// What a descent looked at, and what of it is left to look at: nodes that were opened, with the children that were not,
// and leaves, with the bounds of their facets. What later hunts cannot find any more is dropped.
struct Opened {
    struct Place {
        Bounds bounds;       // away from the first `away` touches
        std::int32_t index;  // of the node or leaf
        int away;
        std::int32_t first;  // child, and its level; those that are left
        int level;
        unsigned lanes;
    };
    static constexpr int most_nodes = 256, most_leaves = 192;
    static_assert(most_nodes % lanes == 0);
    Place nodes[most_nodes], leaves[most_leaves];
    int node_count = 0, leaf_count = 0;
    bool all = true;  // nothing was forgotten
};

// How eight boxes or facets lie about a touch.
struct Span {
    Float8 farthest;  // down its slope less counts
    Float8 within;    // along its plane, at least
    Float8 off;       // its plane, at most
    Float8 along;     // the force, at most
};

class Descent {
public:
    Descent(const Model& m, const Query& q, const Form<Float8>& form, const NodeQuery& node, const Hunt& hunt, Found& best,
            Opened& opened)
        : m_(m), q_(q), form_(form), hunt_(hunt), node_(node), best_(best), opened_(opened),
          most_misfit_(beyond_rounding(hunt.most_misfit)), least_prior_(float(std::max(hunt.least_prior, -1e30))),
          follow_cost_(hunt.previous ? beyond_rounding(hunt.follow_cost) : 0.0f) {
        for (int i = 0; i < hunt.away_count; ++i)
            away_[i] = near_touch(m, hunt.away[i], hunt.radius[i], hunt.depth);
        set_cut();
        if (hunt.layers) layer_limit_ = beyond_rounding(hunt.away[0].misfit + layer_cost);
        if (hunt.previous) follow_ = near_point(m, *hunt.previous, hunt.follow_distance);
        if (hunt.away_count == 0) return;
        const Vec3 c = (1.0 / m.frame.scale) * (hunt.away[0].point - m.frame.centre);
        wa_ = float(q.form.ma - dot(c, q.b)), wb_ = float(q.form.mb + dot(c, q.a));
    }

    // From the root.
    void from_root() {
        best_first_ = true, least_[0] = Float8{} + never;
        open(m_.tree.root(), m_.tree.level_of(m_.tree.root()));
        run();
    }

    // On from what was looked at before. What no later hunt can find is forgotten; inside a place, nothing is.
    void go_on() {
        const float most = hunt_.inside ? never : beyond_rounding(hunt_.limit + hunt_.more);
        int left = 0;
        for (int i = 0; i < opened_.leaf_count; ++i) {
            Opened::Place& p = opened_.leaves[i];
            const Float8 better = prior(m_.tree.leaves[std::size_t(p.index)].bonus) + follow_cost_;
            judge_facets(p);
            if (mask_of(p.bounds.d2 - better <= most) == 0) continue;
            if (left < i) opened_.leaves[left] = p;
            ++left;
        }
        opened_.leaf_count = left;
        left = 0;
        for (int i = 0; i < opened_.node_count; ++i) {
            Opened::Place& p = opened_.nodes[i];
            const Node& node = m_.tree.nodes[std::size_t(p.index)];
            const Float8 better = prior(node.bonus) + follow_cost_;
            p.lanes &= mask_of(p.bounds.d2 - better <= most);
            if (p.lanes == 0) continue;
            Float8 keys = Float8{} + never;
            if ((mask_of(p.bounds.d2 - better <= cut_) & p.lanes) != 0)
                keys = select(lanes_of(p.lanes), node_keys(node, boxes_of(node), p.bounds, p.away), keys);
            keys_[left] = keys;
            if (left < i) opened_.nodes[left] = p;
            ++left;
        }
        opened_.node_count = left;
        run_in_turn();
    }

private:
    static constexpr float never = 1e38f;

    void judge(std::size_t slot) {
        judge_facet(m_, slot, q_, hunt_, best_);
        set_cut();
    }

    void set_cut() { cut_ = beyond_rounding(best_.layered ? hunt_.limit : std::min(best_.key, hunt_.limit)); }

    // In turn, where nothing better is likely to be found: no visit waits for what another tells.
    void run_in_turn() {
        for (int i = 0; i < opened_.node_count; ++i) {
            Opened::Place& p = opened_.nodes[i];
            for (unsigned left = mask_of(keys_[i] <= cut_); left != 0; left &= left - 1) {
                const int lane = std::countr_zero(left);
                if (!(keys_[i][lane] <= cut_)) continue;
                p.lanes &= ~(1u << lane);
                visit(p.first + lane, p.level);
            }
        }
    }

    // The least key first, wherever it is in the tree: going down the first good branch to its end would look at all
    // that is better than the best so far, which is bad at first. The least is found by looking at all: they are few, and
    // a heap's branches cannot be foretold.
    void run() {
        while (true) {
            const int groups = (opened_.node_count + lanes - 1) / lanes;
            Float8 each = least_[0];
            for (int g = 1; g < groups; ++g) each = smaller(each, least_[g]);
            const float key = least_of(each);
            if (!(key <= cut_)) return;
            int g = 0;
            while (mask_of(least_[g] == key) == 0) ++g;
            const int i = lanes * g + std::countr_zero(mask_of(least_[g] == key));
            const int lane = std::countr_zero(mask_of(keys_[i] == key));
            Opened::Place& p = opened_.nodes[i];
            p.lanes &= ~(1u << lane);
            queue(i, select(lane_numbers == lane, Float8{} + never, keys_[i]));
            visit(p.first + lane, p.level);
        }
    }

    // Whole packs are written, as whole packs are read: a processor waits where a read spans a shorter write.
    void queue(int i, Float8 keys) {
        keys_[i] = keys;
        Float8& group = least_[i / lanes];
        group = select(lane_numbers == i % lanes, Float8{} + least_of(keys), group);
    }

    // A child, of the level below 0 a leaf.
    void visit(std::int32_t child, int level) {
        if (level < 0) judge_leaf(std::size_t(child));
        else open(child, level);
    }

    CONTACTBENCH_INLINE Float8 prior(const std::uint8_t* bonus) const {
        return larger(m_.tree.priors.of(bonus), Float8{} + least_prior_);
    }

    void open(std::int32_t index, int level) {
        const Node& node = m_.tree.nodes[std::size_t(index)];
        const Boxes boxes = boxes_of(node);
        Bounds bounds = node_bound(node, boxes, node_);
        int away = 0;
        Hierarchy::Children children = m_.tree.children(index, level--);
        children.which &= mask_of(bounds.d2 <= most_misfit_);
        if (children.which == 0) return;  // for later hunts, too
        const Float8 keys = select(lanes_of(children.which), node_keys(node, boxes, bounds, away), Float8{} + never);
        if (large_) fetch_children(children.first, level, mask_of(keys <= cut_));
        if (opened_.node_count < Opened::most_nodes) {
            const int i = opened_.node_count++;
            opened_.nodes[i] = {bounds, index, away, children.first, level, children.which};
            keys_[i] = keys;
            if (!best_first_) return;
            if (i % lanes == 0) least_[i / lanes] = Float8{} + never;
            return queue(i, keys);
        }
        opened_.all = false;  // from here as deep as the tree at most
        for (unsigned left = mask_of(keys <= cut_); left != 0; left &= left - 1) {
            const int l = std::countr_zero(left);
            if (keys[l] <= cut_) visit(children.first + l, level);
        }
    }

    // On a large mesh most of the time is waiting for memory. All that may be looked at is asked for at once.
    CONTACTBENCH_INLINE void fetch_children(std::int32_t first, int level, unsigned which) const {
        for (; which != 0; which &= which - 1) {
            const std::size_t child = std::size_t(first + std::countr_zero(which));
            if (level >= 0) {
                fetch(m_.tree.nodes[child]);
                continue;
            }
            fetch(m_.tree.leaves[child]);
            __builtin_prefetch(&m_.tree.face[lanes * child]);
        }
    }

    CONTACTBENCH_INLINE void fetch_facets(std::size_t index, unsigned which) const {
        for (; which != 0; which &= which - 1) {
            const std::int32_t face = m_.tree.face[index * lanes + std::size_t(std::countr_zero(which))];
            if (face < 0) continue;
            for (const std::int32_t v : m_.faces[std::size_t(face)]) __builtin_prefetch(&m_.vertices[std::size_t(v)]);
            __builtin_prefetch(&m_.normals[std::size_t(face)]);
            __builtin_prefetch(&m_.errors[std::size_t(face)]);
            __builtin_prefetch(&m_.kind[std::size_t(face)]);
        }
    }

    template <class T>
    CONTACTBENCH_INLINE static void fetch(const T& of) {
        for (std::size_t at = 0; at < sizeof of; at += 64) __builtin_prefetch(reinterpret_cast<const char*>(&of) + at);
    }

    // Lower bounds of the key in each child; 1e38 where there can be nothing. Moves the bounds away from all touches.
    CONTACTBENCH_INLINE Float8 node_keys(const Node& n, const Boxes& box, Bounds& bounds, int& away) const {
        const Float8 cx = box.cx, cy = box.cy, cz = box.cz, ex = box.ex, ey = box.ey, ez = box.ez;
        const Float8 zero{}, nothing = zero + never, size = root(ex * ex + ey * ey + ez * ez);
        const auto span = [&](const Near& b) {
            const Float8 x = cx - b.x, y = cy - b.y, z = cz - b.z, square = x * x + y * y + z * z;
            const Float8 down = x * b.sx + y * b.sy + z * b.sz, along = x * node_.fx + y * node_.fy + z * node_.fz;
            const Float8 off = magnitude(x * b.nx + y * b.ny + z * b.nz);
            return Span{root(larger(square - down * down, zero)) + size, root(larger(square - off * off, zero)) - size,
                        off + (ex * std::fabs(b.nx) + ey * std::fabs(b.ny) + ez * std::fabs(b.nz)),
                        magnitude(along) + (ex * node_.gx + ey * node_.gy + ez * node_.gz)};
        };
        leave(bounds, away, span);
        Float8 key = bounds.d2 - prior(n.bonus);
        if (follow_cost_ > 0.0f) {
            const Float8 x = larger(magnitude(cx - follow_.x) - ex, zero), y = larger(magnitude(cy - follow_.y) - ey, zero),
                         z = larger(magnitude(cz - follow_.z) - ez, zero);
            key = select(x * x + y * y + z * z <= follow_.outer * follow_.outer, key - follow_cost_, key);
        }
        return select(bounds.d2 <= most_misfit_, key, nothing);
    }

    // Moves bounds of d2 away from what was found: what is all near it has its best touch there.
    template <class Spanned>
    CONTACTBENCH_INLINE void leave(Bounds& bounds, int& away, const Spanned& span) const {
        for (int i = away; i < hunt_.away_count; ++i) {
            const Near& b = away_[i];
            const Span s = span(b);
            const Float8 within = larger(s.within, Float8{});
            const Int8 flat = s.off <= b.flat + b.tilt * within;
            Float8 d2 = bounds.d2;
            if (i == 0) d2 = select(flat, larger(d2, beyond(s.along, bounds)), d2);
            d2 = select(flat & (s.farthest < b.inner), Float8{} + never, d2);
            // Where a layer may be, its own bound counts.
            if (hunt_.layers) d2 = select((bounds.d2 <= layer_limit_) & (s.off > b.own + b.lean * within), bounds.d2, d2);
            bounds.d2 = d2;
        }
        if (!hunt_.layers) away = hunt_.away_count;  // then later hunts have more that they need not look at
    }

    // A lower bound of d2 away from the likeliest touch, for what lies on its plane and reaches no further than `along`
    // from it along the force: what is away from it is away across the force or along it, and across is off w*.
    CONTACTBENCH_INLINE Float8 beyond(Float8 along, const Bounds& bounds) const {
        const Float8 far = along + node_.margin, across = root(larger(away_[0].inner * away_[0].inner - far * far, Float8{}));
        const Float8 a = bounds.wa - wa_, b = bounds.wb - wb_;
        const Float8 miss = larger(across - (root(a * a + b * b) + bounds.near + 2.0f * node_.margin), Float8{});
        return miss * miss / bounds.V * (1.0f - 2e-3f);
    }

    void judge_leaf(std::size_t index) {
        const Leaf& leaf = m_.tree.leaves[index];
        const Bounds bounds = leaf_bound(leaf, form_, node_, most_misfit_);
        if (mask_of(bounds.d2 <= most_misfit_) == 0) return;  // for later hunts, too
        Opened::Place one, &place = opened_.leaf_count < Opened::most_leaves ? opened_.leaves[opened_.leaf_count++] : one;
        opened_.all &= &place != &one;
        place = {bounds, std::int32_t(index), 0, 0, 0, 0};
        judge_facets(place);
    }

    void judge_facets(Opened::Place& place) {
        const std::size_t index = std::size_t(place.index);
        const Leaf& leaf = m_.tree.leaves[index];
        const Bounds& bounds = place.bounds;
        const Float8& d2 = bounds.d2;
        const Float8 better = prior(leaf.bonus) + follow_cost_;
        if (mask_of((d2 - better <= cut_) & (d2 <= most_misfit_)) == 0) return;
        if (place.away < hunt_.away_count) {
            Float8 longest{};
            const Float8(&p)[3][3] = facets_of(leaf, form_).p;
            for (int c = 0; c < 3; ++c) {
                const Float8 *v = p[c], *w = p[(c + 1) % 3], x = v[0] - w[0], y = v[1] - w[1], z = v[2] - w[2];
                longest = larger(longest, x * x + y * y + z * z);
            }
            const Float8 size = 0.58f * root(longest);  // no point of a facet is further from its nearest corner
            leave(place.bounds, place.away, [&](const Near& b) { return leaf_span(p, size, leaf.step, b); });
        }
        const Float8 key = select(d2 <= most_misfit_, d2 - better, Float8{} + never);
        unsigned left = mask_of(key <= cut_);
        if (large_) fetch_facets(index, left);
        while (left != 0) {
            int l = std::countr_zero(left);
            for (unsigned mask = left & (left - 1); mask != 0; mask &= mask - 1)
                if (key[std::countr_zero(mask)] < key[l]) l = std::countr_zero(mask);
            if (key[l] > cut_) return;
            left &= ~(1u << l);
            const std::size_t slot = index * lanes + std::size_t(l);
            if (m_.tree.face[slot] >= 0) judge(slot);
        }
    }

    CONTACTBENCH_INLINE Span leaf_span(const Float8 (&p)[3][3], const Float8& size, float step, const Near& b) const {
        Float8 farthest{}, off{}, reach{}, nearest = Float8{} + never;
        for (int c = 0; c < 3; ++c) {
            const Float8 x = p[c][0] - b.x, y = p[c][1] - b.y, z = p[c][2] - b.z, square = x * x + y * y + z * z;
            const Float8 down = x * b.sx + y * b.sy + z * b.sz, along = x * node_.fx + y * node_.fy + z * node_.fz;
            farthest = larger(farthest, square - down * down);
            const Float8 height = magnitude(x * b.nx + y * b.ny + z * b.nz);
            nearest = smaller(nearest, square - height * height);
            reach = larger(reach, magnitude(along));
            off = larger(off, height);
        }
        return {root(farthest) + step, root(larger(nearest, Float8{})) - size - step, off + step, reach + step};
    }

    const Model& m_;
    const Query& q_;
    const Form<Float8>& form_;
    const Hunt& hunt_;
    const NodeQuery& node_;
    Found& best_;
    Opened& opened_;
    float most_misfit_, least_prior_, follow_cost_;
    bool best_first_ = false;
    bool large_ = m_.tree.large();
    float cut_;  // keys beyond this are of no use: single precision, rounded up
    float wa_ = 0.0f, wb_ = 0.0f;  // w of the likeliest touch
    float layer_limit_ = -never;   // of the d2 of a layer
    Near away_[Answer::capacity], follow_{};
    Float8 keys_[Opened::most_nodes];           // of the children that are left
    Float8 least_[Opened::most_nodes / lanes];  // of those, by node
};

}  // namespace detail

// Every facet, one by one and without any bound: the yardstick for `Search`.
class Exhaustion {
public:
    Exhaustion(const Model& m, const Query& q, double) : m_(m), q_(q) {}

    void first(const Hunt& hunt, std::int32_t, detail::Found& best) { next(hunt, best); }
    void next(const Hunt& hunt, detail::Found& best) const {
        best.clear(hunt.layers);
        for (std::size_t s = 0; s < m_.tree.face.size(); ++s)
            if (m_.tree.face[s] >= 0) detail::judge_facet(m_, s, q_, hunt, best);
    }

private:
    const Model& m_;
    const Query& q_;
};

// Through the hierarchy.
class Search {
public:
    Search(const Model& m, const Query& q, double cos_friction)
        : m_(m), q_(q), form_(in_lanes(q.form)), node_(make_node_query(q, cos_friction)) {}

    // `hint`: a slot that is looked at first, or -1; it changes the time, never the answer.
    void first(const Hunt& hunt, std::int32_t hint, detail::Found& best) {
        best.clear(false);
        if (hint >= 0) detail::judge_facet(m_, std::size_t(hint), q_, hunt, best);
        detail::Descent(m_, q_, form_, node_, hunt, best, opened_).from_root();
    }

    void next(const Hunt& hunt, detail::Found& best) {
        best.clear(hunt.layers);
        detail::Descent descent(m_, q_, form_, node_, hunt, best, opened_);
        if (opened_.all) return descent.go_on();
        opened_.node_count = opened_.leaf_count = 0;
        descent.from_root();
    }

private:
    const Model& m_;
    const Query& q_;
    Form<Float8> form_;
    NodeQuery node_;
    detail::Opened opened_;
};

}  // namespace contactbench
