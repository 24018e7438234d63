// Following a stream: a cut through the hierarchy that holds every contact of all wrenches near a
// reference.
//
// A walk over neighbouring facets finds *a* contact in constant time, but on a non-convex probe, and
// every real one is, it cannot vouch that no other facet accepts the wrench too. A cut can: it is the set
// of subtrees that could hold a contact of any wrench within reach of the reference, flattened into a
// few nodes. While the stream stays within reach, a search from the cut finds exactly what one from the
// root finds; when it leaves, the sample is solved cold and the cut is made anew. Nothing is guessed, so
// tracking and a cold solve cannot differ.
//
// The reach is measured where the contact is. With q(x) = m - x x f, an anchor a and |f' - f| <= turn,
// |q'(a) - q(a)| <= shift, every x has |q'(x) - q(x)| <= shift + turn |x - a|.
//
// Contract: one Tracker per stream; not thread-safe. No allocation after construction.
#pragma once

#include "search.hpp"

namespace contactbench {

// All wrenches within `turn` and `shift` of a reference, dimensionless.
struct Neighbourhood {
    Query reference;
    Vec3 anchor, moment;  // a and q(a)
    double turn = 0.0, shift = 0.0;

    bool holds(const Query& q) const {
        return norm2(q.f - reference.f) <= turn * turn &&
               norm2((q.m - cross(anchor, q.f)) - moment) <= shift * shift;
    }
    // How far the pitch h = q(a) . f may be off.
    double pitch_reach() const { return shift + (norm(moment) + shift) * turn; }
};

namespace detail {

// A node test for a whole neighbourhood.
struct WideQuery {
    NodeQuery n;
    float ax, ay, az;  // anchor
    float turn, shift, pitch;
    float free;  // large when even the sign of h may differ: any normal will do
};

inline WideQuery make_wide_query(const Neighbourhood& near, double cos_cap) {
    const Query& q = near.reference;
    const double pitch = near.pitch_reach();
    WideQuery w{make_node_query(q, cos_cap), float(near.anchor.x), float(near.anchor.y),
                float(near.anchor.z), float(near.turn), float(near.shift), float(std::fabs(q.h) + pitch),
                std::fabs(q.h) <= pitch ? 1e15f : 0.0f};
    w.n.margin *= 2.0f;
    return w;
}

// Largest |h| tan(angle to -f) that a normal of each child's cone allows.
CONTACTBENCH_INLINE Float8 widest_offset(Float8 back, Float8 cos_a, Float8 sin_a, const WideQuery& w) {
    Float8 offset;
    for (int l = 0; l < lanes; ++l) {
        const float c = std::min(1.0f, std::max(-1.0f, back[l])), s = std::min(1.0f, sin_a[l]);
        const float steepest = std::max(c * cos_a[l] - std::sqrt(1.0f - c * c) * s - w.turn, w.n.cos_t - w.turn);
        const float safe = std::max(steepest, 0.01f);
        offset[l] = w.pitch * std::sqrt(1.0f - std::min(1.0f, safe * safe)) / safe;
    }
    return offset;
}

// node_mask with each child's own reach. Compare the comments there; |.|_1 stands in for lengths.
CONTACTBENCH_INLINE unsigned wide_mask(const Node& n, const WideQuery& w) {
    const NodeQuery& q = w.n;
    const Float8 cx = load8(n.cx), cy = load8(n.cy), cz = load8(n.cz);
    const Float8 ex = load8(n.ex), ey = load8(n.ey), ez = load8(n.ez), radius = load8(n.radius);
    const Float8 ax = load8(n.ax), ay = load8(n.ay), az = load8(n.az);
    const Float8 cos_a = load8(n.cos_a), sin_a = load8(n.sin_a);
    const Float8 away = magnitude(cx - w.ax) + magnitude(cy - w.ay) + magnitude(cz - w.az) + radius;
    const Float8 reach = w.turn * away + (w.shift + q.margin);
    const Float8 vx = q.mx + (cy * q.fz - cz * q.fy);
    const Float8 vy = q.my + (cz * q.fx - cx * q.fz);
    const Float8 vz = q.mz + (cx * q.fy - cy * q.fx);
    const Float8 tx = ey * q.gz + ez * q.gy, ty = ez * q.gx + ex * q.gz, tz = ex * q.gy + ey * q.gx;
    // v leaves out the share of q along f; when f turns, that share turns with it.
    const Float8 tilt = w.turn * (magnitude(vx) + magnitude(vy) + magnitude(vz) + radius + reach + q.h);
    const Float8 back = ax * q.nx + ay * q.ny + az * q.nz;
    const Float8 slab = smaller(smaller(tx - magnitude(vx), ty - magnitude(vy)), tz - magnitude(vz)) +
                        (reach + tilt + widest_offset(back, cos_a, sin_a, w));
    const Float8 front = back - (cos_a * q.cos_t - sin_a * q.sin_t) + (w.turn + q.margin);
    const Float8 ball = radius + reach;
    const Float8 clear2 = ((vx * vx + vy * vy + vz * vz) + q.h2) - ball * ball;
    const Float8 along = (ax * vx + ay * vy + az * vz) + q.h * back + sin_a * ball + (w.free + q.margin);
    const Float8 cone = along * magnitude(along) - load8(n.cos2_a) * clear2;
    return nonnegative(smaller(smaller(larger(cone, -clear2), front), slab));
}

}  // namespace detail

class Cut {
public:
    static constexpr int capacity = 4 * lanes;

    // Every subtree that may matter in the neighbourhood, opened level by level while it fits.
    void build(const Hierarchy& tree, const Neighbourhood& near, double cos_cap) {
        const detail::WideQuery wide = detail::make_wide_query(near, cos_cap);
        Place level[capacity], next[capacity];
        int count = open(tree, 0, wide, level, 0);
        for (bool grew = true; grew;) {
            grew = false;
            int n = 0;
            for (int i = 0; i < count; ++i) {
                const std::int32_t child = tree.nodes[std::size_t(level[i].node)].child[level[i].lane];
                const int rest = count - i - 1;
                if (child < 0 || n + lanes + rest > capacity) {
                    next[n++] = level[i];
                } else {
                    n = open(tree, child, wide, next, n);
                    grew = true;
                }
            }
            std::copy(next, next + n, level);
            count = n;
        }
        pack(tree, level, count);
    }

    const Node* begin() const { return nodes_.data(); }
    const Node* end() const { return nodes_.data() + size_; }

private:
    struct Place {
        std::int32_t node, lane;
    };

    static int open(const Hierarchy& tree, std::int32_t index, const detail::WideQuery& wide, Place* places,
                    int count) {
        const Node& node = tree.nodes[std::size_t(index)];
        for (unsigned mask = detail::wide_mask(node, wide); mask != 0; mask &= mask - 1) {
            const int lane = std::countr_zero(mask);
            if (node.child[lane] != empty_child) places[count++] = {index, lane};
        }
        return count;
    }

    void pack(const Hierarchy& tree, const Place* places, int count) {
        size_ = (count + lanes - 1) / lanes;
        for (int i = 0; i < size_ * lanes; ++i) {
            Node& to = nodes_[std::size_t(i / lanes)];
            const int l = i % lanes;
            to.child[l] = empty_child;
            if (i < count) copy_lane(tree.nodes[std::size_t(places[i].node)], places[i].lane, to, l);
        }
    }

    static void copy_lane(const Node& from, int s, Node& to, int l) {
        to.cx[l] = from.cx[s], to.cy[l] = from.cy[s], to.cz[l] = from.cz[s];
        to.ex[l] = from.ex[s], to.ey[l] = from.ey[s], to.ez[l] = from.ez[s];
        to.ax[l] = from.ax[s], to.ay[l] = from.ay[s], to.az[l] = from.az[s];
        to.radius[l] = from.radius[s];
        to.cos_a[l] = from.cos_a[s], to.sin_a[l] = from.sin_a[s], to.cos2_a[l] = from.cos2_a[s];
        to.child[l] = from.child[s];
    }

    std::array<Node, capacity / lanes> nodes_;
    int size_ = 0;
};

inline void search_from(const Cut& cut, const Model& model, const Query& q, double cos_cap, Hits& hits) {
    const NodeQuery nq = make_node_query(q, cos_cap);
    test_leaves(model, q, nq, cos_cap, hits, [&](auto&& leaf) {
        NodeStack stack;
        const auto test = [&](const Node& n) { return node_mask(n, nq); };
        for (const Node& node : cut) {
            push_children(model.tree.nodes.data(), node, test(node), stack, leaf);
            descend(model.tree.nodes.data(), stack, test, leaf);
        }
    });
}

// Decides when to make a cut, and how far it should reach.
class Tracker {
public:
    bool covers(const Query& q) const { return active_ && prunable(q) && near_.holds(q); }
    const Cut& cut() const { return cut_; }
    void served() { ++served_; }

    // After a cold solve of `q` that gave `chosen`. `turn` and `shift`: standard deviations of the force
    // direction and of the axis at the contact, dimensionless.
    void follow(const Model& m, const Query& q, double cos_cap, const Candidate& chosen, double turn,
                double shift) {
        // A cut that the stream left at once did not pay: wait a little longer before the next one.
        if (active_) pause_ = served_ < 4 ? std::min(2 * pause_ + 1, 15) : 0;
        active_ = false;
        if (waited_++ < pause_ || !prunable(q)) return;
        waited_ = 0;
        served_ = 0;
        near_.reference = q;
        near_.anchor = (1.0 / m.frame.scale) * (chosen.point - m.frame.centre);
        near_.moment = q.m - cross(near_.anchor, q.f);
        near_.turn = std::min(5.0 * turn + 0.02, 0.3);
        near_.shift = std::min(5.0 * shift + 0.02, 0.3);
        cut_.build(m.tree, near_, cos_cap);
        active_ = true;
    }

    void reset() { *this = Tracker(); }

private:
    Cut cut_;
    Neighbourhood near_;
    std::int64_t served_ = 0;
    int pause_ = 0, waited_ = 0;
    bool active_ = false;
};

}  // namespace contactbench
