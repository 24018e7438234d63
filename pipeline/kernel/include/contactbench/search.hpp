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
    double least_prior = -HUGE_VAL;
    double follow_cost = 0.0, follow_distance = 0.0;
    const Vec3* previous = nullptr;  // S, m
    const Candidate* away = nullptr;  // not within its own radius of one of these
    double radius[Answer::capacity];  // m
    int away_count = 0;
};

namespace detail {

// Of touches of one key the surface met first counts, then the facet of the lowest number.
struct Rank {
    double key = HUGE_VAL, depth = HUGE_VAL;  // to_tie()
    std::int32_t face = -1;

    auto operator<=>(const Rank&) const = default;
};

struct Found {
    double key = HUGE_VAL;
    Rank rank;
    Candidate touch;  // slot < 0: none
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
    if (!(key <= hunt.limit) || key > best.key + tie) return;
    const Rank rank{to_tie(key), to_tie(dot((1.0 / m.frame.scale) * (point - m.frame.centre), q.f)), face};
    if (!(rank < best.rank)) return;
    for (int i = 0; i < hunt.away_count; ++i)
        if (apart(hunt.away[i], point) <= hunt.radius[i]) return;
    best.key = key, best.rank = rank;
    Candidate& c = best.touch;
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

// What is near a touch, in the search's own numbers: see apart().
struct Near {
    float x, y, z, sx, sy, sz;  // centre and slope, normalised
    float inner, outer;         // radii less and more what rounding may do
};

inline Near near_touch(const Model& m, Vec3 centre, Vec3 slope, double radius) {
    const Vec3 c = (1.0 / m.frame.scale) * (centre - m.frame.centre);
    const float r = float(radius / m.frame.scale);
    return {float(c.x), float(c.y), float(c.z), float(slope.x), float(slope.y), float(slope.z),
            std::max(r * (1.0f - 1e-5f) - 2.0f * slack, 0.0f), r * (1.0f + 1e-5f) + 2.0f * slack};
}

inline float beyond_rounding(double x) { return x < 1e30 ? float(x + 1e-6 * std::fabs(x) + 1e-6) : 1e30f; }

// What a descent looked at, and what of it is left to look at: nodes that were opened, with the children that were not,
// and leaves, with the bounds of their facets.
struct Opened {
    struct Place {
        Bounds bounds;
        std::int32_t index;  // of the node or leaf
        unsigned lanes;      // children that are left
    };
    static constexpr int most_nodes = 128, most_leaves = 64;
    static_assert(most_nodes % lanes == 0);
    Place nodes[most_nodes], leaves[most_leaves];
    int node_count = 0, leaf_count = 0;
    bool all = true;  // nothing was forgotten
};

class Descent {
public:
    Descent(const Model& m, const Query& q, const Form<float>& form, const NodeQuery& node, const Hunt& hunt, Found& best,
            Opened& opened)
        : m_(m), q_(q), form_(form), hunt_(hunt), node_(node), best_(best), opened_(opened),
          most_misfit_(beyond_rounding(hunt.most_misfit)), least_prior_(float(std::max(hunt.least_prior, -1e30))),
          follow_cost_(hunt.previous ? beyond_rounding(hunt.follow_cost) : 0.0f) {
        for (int i = 0; i < hunt.away_count; ++i) away_[i] = near_touch(m, hunt.away[i].point, hunt.away[i].slope, hunt.radius[i]);
        if (hunt.previous) follow_ = near_touch(m, *hunt.previous, {}, hunt.follow_distance);
        if (hunt.away_count == 0) return;
        const Vec3 c = (1.0 / m.frame.scale) * (hunt.away[0].point - m.frame.centre);
        wa_ = float(q.form.ma - dot(c, q.b)), wb_ = float(q.form.mb + dot(c, q.a));
        depth_ = float(dot(c, q.f));
    }

    // From the root.
    void from_root() {
        open(m_.tree.root());
        run();
    }

    // On from what was looked at before.
    void go_on() {
        for (int i = 0; i < opened_.leaf_count; ++i) {
            const Opened::Place& p = opened_.leaves[i];
            judge_facets(std::size_t(p.index), p.bounds);
        }
        for (int i = 0; i < opened_.node_count; ++i) {
            const Opened::Place& p = opened_.nodes[i];
            const Node& node = m_.tree.nodes[std::size_t(p.index)];
            if (i % lanes == 0) least_[i / lanes] = Float8{} + never;
            if ((mask_of(p.bounds.d2 - prior(node.bonus) - follow_cost_ <= cut()) & p.lanes) == 0) continue;
            queue(i, select(lanes_of(p.lanes), node_keys(node, boxes_of(node), p.bounds), Float8{} + never));
        }
        run();
    }

private:
    static constexpr float never = 1e38f;

    // Keys beyond this are of no use: single precision, rounded up.
    float cut() const { return beyond_rounding(std::min(best_.key, hunt_.limit)); }

    // The least key first, wherever it is in the tree: going down the first good branch to its end would look at all
    // that is better than the best so far, which is bad at first. The least is found by looking at all: they are few, and
    // a heap's branches cannot be foretold.
    void run() {
        while (true) {
            const int groups = (opened_.node_count + lanes - 1) / lanes;
            Float8 each = least_[0];
            for (int g = 1; g < groups; ++g) each = smaller(each, least_[g]);
            const float key = least_of(each);
            if (!(key <= cut())) return;
            int g = 0;
            while (mask_of(least_[g] == key) == 0) ++g;
            const int i = lanes * g + std::countr_zero(mask_of(least_[g] == key));
            const int lane = std::countr_zero(mask_of(keys_[i] == key));
            Opened::Place& p = opened_.nodes[i];
            p.lanes &= ~(1u << lane);
            queue(i, select(lane_numbers == lane, Float8{} + never, keys_[i]));
            visit(m_.tree.child(p.index, lane));
        }
    }

    // Whole packs are written, as whole packs are read: a processor waits where a read spans a shorter write.
    void queue(int i, Float8 keys) {
        keys_[i] = keys;
        Float8& group = least_[i / lanes];
        group = select(lane_numbers == i % lanes, Float8{} + least_of(keys), group);
    }

    void visit(std::int32_t child) {
        if (child < 0) judge_leaf(std::size_t(~child));
        else open(child);
    }

    CONTACTBENCH_INLINE Float8 prior(const std::uint8_t* bonus) const {
        return larger(m_.tree.priors.of(bonus), Float8{} + least_prior_);
    }

    void open(std::int32_t index) {
        const Node& node = m_.tree.nodes[std::size_t(index)];
        const Boxes boxes = boxes_of(node);
        const Bounds bounds = node_bound(node, boxes, node_);
        const unsigned children = m_.tree.children(index);
        const Float8 keys = select(lanes_of(children), node_keys(node, boxes, bounds), Float8{} + never);
        fetch_children(index, mask_of(keys <= cut()));
        if (opened_.node_count < Opened::most_nodes) {
            const int i = opened_.node_count++;
            opened_.nodes[i] = {bounds, index, children};
            if (i % lanes == 0) least_[i / lanes] = Float8{} + never;
            return queue(i, keys);
        }
        opened_.all = false;  // from here as deep as the tree at most
        for (unsigned left = mask_of(keys <= cut()); left != 0; left &= left - 1) {
            const int l = std::countr_zero(left);
            if (keys[l] <= cut()) visit(m_.tree.child(index, l));
        }
    }

    // On a large mesh most of the time is waiting for memory. All that may be looked at is asked for at once.
    CONTACTBENCH_INLINE void fetch_children(std::int32_t index, unsigned which) const {
        for (; which != 0; which &= which - 1) {
            const std::int32_t child = m_.tree.child(index, std::countr_zero(which));
            if (child >= 0) {
                fetch(m_.tree.nodes[std::size_t(child)]);
                continue;
            }
            fetch(m_.tree.leaves[std::size_t(~child)]);
            __builtin_prefetch(&m_.tree.face[lanes * std::size_t(~child)]);
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

    // Lower bounds of the key in each child; 1e38 where there can be nothing.
    CONTACTBENCH_INLINE Float8 node_keys(const Node& n, const Boxes& box, const Bounds& bounds) const {
        const auto& [cx, cy, cz, ex, ey, ez] = box;
        const Float8 zero{}, nothing = zero + never;
        Float8 d2 = bounds.d2;
        for (int i = 0; i < hunt_.away_count; ++i) {
            const Near& b = away_[i];
            const Float8 x = cx - b.x, y = cy - b.y, z = cz - b.z, down = x * b.sx + y * b.sy + z * b.sz;
            const Float8 from_centre = root(larger(x * x + y * y + z * z - down * down, zero));
            d2 = select(from_centre + root(ex * ex + ey * ey + ez * ez) < b.inner, nothing, d2);
        }
        if (hunt_.away_count > 0) {
            const NodeQuery& q = node_;
            d2 = larger(d2, beyond(magnitude(cx * q.fx + cy * q.fy + cz * q.fz - depth_) +
                                       (ex * q.gx + ey * q.gy + ez * q.gz), bounds));
        }
        Float8 key = d2 - prior(n.bonus);
        if (follow_cost_ > 0.0f) {
            const Float8 x = larger(magnitude(cx - follow_.x) - ex, zero), y = larger(magnitude(cy - follow_.y) - ey, zero),
                         z = larger(magnitude(cz - follow_.z) - ez, zero);
            key = select(x * x + y * y + z * z <= follow_.outer * follow_.outer, key - follow_cost_, key);
        }
        return select(bounds.faces_force & (d2 <= most_misfit_), key, nothing);
    }

    // A lower bound of d2 away from the likeliest touch, for what reaches no further than `along` from it along
    // the force: what is away from it is away across the force or along it, and across is off w*.
    CONTACTBENCH_INLINE Float8 beyond(Float8 along, const Bounds& bounds) const {
        const Float8 far = along + node_.margin, across = root(larger(away_[0].inner * away_[0].inner - far * far, Float8{}));
        const Float8 a = bounds.wa - wa_, b = bounds.wb - wb_;
        const Float8 miss = larger(across - (root(a * a + b * b) + bounds.near + 2.0f * node_.margin), Float8{});
        return miss * miss / bounds.V * (1.0f - 2e-3f);
    }

    void judge_leaf(std::size_t index) {
        const Leaf& leaf = m_.tree.leaves[index];
        Float8 p[3][3];
        corners_of(leaf, p);
        const Bounds bounds = leaf_bound(leaf, p, form_, node_);
        if (opened_.leaf_count < Opened::most_leaves) opened_.leaves[opened_.leaf_count++] = {bounds, std::int32_t(index), 0};
        else opened_.all = false;
        judge_facets(index, bounds);
    }

    void judge_facets(std::size_t index, const Bounds& bounds) {
        const Leaf& leaf = m_.tree.leaves[index];
        Float8 d2 = bounds.d2;
        const Float8 better = prior(leaf.bonus) + follow_cost_;
        if (mask_of(bounds.faces_force & (d2 - better <= cut()) & (d2 <= most_misfit_)) == 0) return;
        if (hunt_.away_count > 0) d2 = away(leaf, bounds);
        Float8 key = select(bounds.faces_force & (d2 <= most_misfit_), d2 - better, Float8{} + never);
        fetch_facets(index, mask_of(key <= cut()));
        for (unsigned left = mask_of(key <= cut()); left != 0;) {
            int l = std::countr_zero(left);
            for (unsigned mask = left & (left - 1); mask != 0; mask &= mask - 1)
                if (key[std::countr_zero(mask)] < key[l]) l = std::countr_zero(mask);
            if (key[l] > cut()) return;
            left &= ~(1u << l);
            const std::size_t slot = index * lanes + std::size_t(l);
            if (m_.tree.face[slot] >= 0) judge_facet(m_, slot, q_, hunt_, best_);
        }
    }

    // The bounds of d2 once more, away from what was found: a facet that is all near it has its best touch there.
    CONTACTBENCH_INLINE Float8 away(const Leaf& leaf, const Bounds& bounds) const {
        Float8 p[3][3], d2 = bounds.d2, along{};
        corners_of(leaf, p);
        for (int c = 0; c < 3; ++c) {
            along = larger(along, magnitude(p[c][0] * node_.fx + p[c][1] * node_.fy + p[c][2] * node_.fz - depth_));
        }
        d2 = larger(d2, beyond(along + leaf.step, bounds));
        for (int i = 0; i < hunt_.away_count; ++i) {
            const Near& b = away_[i];
            Float8 farthest{};
            for (int c = 0; c < 3; ++c) {
                const Float8 x = p[c][0] - b.x, y = p[c][1] - b.y, z = p[c][2] - b.z;
                const Float8 down = x * b.sx + y * b.sy + z * b.sz;
                farthest = larger(farthest, x * x + y * y + z * z - down * down);
            }
            const float inner = std::max(b.inner - leaf.step, 0.0f);
            d2 = select(farthest < inner * inner, Float8{} + 1e38f, d2);
        }
        return d2;
    }

    const Model& m_;
    const Query& q_;
    const Form<float>& form_;
    const Hunt& hunt_;
    const NodeQuery& node_;
    Found& best_;
    Opened& opened_;
    float most_misfit_, least_prior_, follow_cost_;
    float wa_ = 0.0f, wb_ = 0.0f, depth_ = 0.0f;  // of the likeliest touch: w, and how far along the force
    Near away_[Answer::capacity], follow_{};
    Float8 keys_[Opened::most_nodes];           // of the children that are left
    Float8 least_[Opened::most_nodes / lanes];  // of those, by node
};

}  // namespace detail

// Every facet, one by one and without any bound: the yardstick for `Search`.
class Exhaustion {
public:
    Exhaustion(const Model& m, const Query& q, double) : m_(m), q_(q) {}

    detail::Found first(const Hunt& hunt, std::int32_t) { return next(hunt); }
    detail::Found next(const Hunt& hunt) const {
        detail::Found best;
        for (std::size_t s = 0; s < m_.tree.face.size(); ++s)
            if (m_.tree.face[s] >= 0) detail::judge_facet(m_, s, q_, hunt, best);
        return best;
    }

private:
    const Model& m_;
    const Query& q_;
};

// Through the hierarchy.
class Search {
public:
    Search(const Model& m, const Query& q, double cos_friction)
        : m_(m), q_(q), form_(in_single(q.form)), node_(make_node_query(q, cos_friction)) {}

    // `hint`: a slot that is looked at first, or -1; it changes the time, never the answer.
    detail::Found first(const Hunt& hunt, std::int32_t hint) {
        detail::Found best;
        if (hint >= 0) detail::judge_facet(m_, std::size_t(hint), q_, hunt, best);
        detail::Descent(m_, q_, form_, node_, hunt, best, opened_).from_root();
        return best;
    }

    detail::Found next(const Hunt& hunt) {
        detail::Found best;
        detail::Descent descent(m_, q_, form_, node_, hunt, best, opened_);
        if (opened_.all) return descent.go_on(), best;
        opened_.node_count = opened_.leaf_count = 0;
        return descent.from_root(), best;
    }

private:
    const Model& m_;
    const Query& q_;
    Form<float> form_;
    NodeQuery node_;
    detail::Opened opened_;
};

}  // namespace contactbench
