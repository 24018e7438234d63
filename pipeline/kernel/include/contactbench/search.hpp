// All candidates of a wrench: exhaustively, or through the hierarchy. Both give the same set.
//
// Contract: `cos_cap` drops candidates whose friction angle is larger; 0 keeps every pushing one.
// exhaust is O(n); search is O(log n + answers) for a bounded pitch. No allocation (see Hits).
#pragma once

#include "candidate.hpp"

namespace contactbench {

namespace detail {

// Which facets of the leaf may accept the wrench, in single precision: the moments m - p x f at the
// corners dotted with the edges, each allowed to be off by the worst rounding of this sum, and by what
// a wrench within `reach` may change.
CONTACTBENCH_INLINE unsigned facet_sieve(const Leaf& leaf, const NodeQuery& q) {
    Float8 p[3][3], moment[3][3];
    for (int c = 0; c < 3; ++c) {
        for (int i = 0; i < 3; ++i) p[c][i] = load8(leaf.corner[c][i]);
        moment[c][0] = q.qx + (p[c][2] * q.oy - p[c][1] * q.oz);
        moment[c][1] = q.qy + (p[c][0] * q.oz - p[c][2] * q.ox);
        moment[c][2] = q.qz + (p[c][1] * q.ox - p[c][0] * q.oy);
    }
    Float8 worst = Float8{} - 1e30f;
    for (int c = 0; c < 3; ++c) {
        const int d = (c + 1) % 3;
        const Float8 x = p[d][0] - p[c][0], y = p[d][1] - p[c][1], z = p[d][2] - p[c][2];
        const Float8 length = magnitude(x) + magnitude(y) + magnitude(z);
        const Float8 size = magnitude(moment[c][0]) + magnitude(moment[c][1]) + magnitude(moment[c][2]);
        const Float8 w = moment[c][0] * x + moment[c][1] * y + moment[c][2] * z;
        worst = larger(worst, w - ((q.margin + q.reach) * length + slack * size));
    }
    return nonnegative(-worst);
}

// Which of the leaf's vertices could have the required normal in their cone.
CONTACTBENCH_INLINE unsigned vertex_sieve(const Leaf& b, const NodeQuery& q) {
    const Float8 px = load8(b.px), py = load8(b.py), pz = load8(b.pz);
    const Float8 vx = q.mx + (py * q.fz - pz * q.fy);
    const Float8 vy = q.my + (pz * q.fx - px * q.fz);
    const Float8 vz = q.mz + (px * q.fy - py * q.fx);
    const Float8 ax = load8(b.ax), ay = load8(b.ay), az = load8(b.az);
    const Float8 size2 = (vx * vx + vy * vy + vz * vz) + q.h2;
    const Float8 along = (ax * vx + ay * vy + az * vz) + q.h * (ax * q.nx + ay * q.ny + az * q.nz) + q.margin;
    return nonnegative(along * magnitude(along) - load8(b.cos2_a) * size2);
}

inline void test_facet(const Model& model, std::size_t slot, const Query& q, double cos_cap, Hits& hits) {
    EdgeMoments moments;
    if (!accepts(model.tree.edges[slot], model.tree.triangle[slot], q, moments)) return;
    const Candidate c = facet_contact(model, slot, moments.w, q);
    if (c.cosine >= std::max(cos_cap, least_cosine)) hits.add(c);
}

inline void test_vertex(const Model& model, std::int32_t v, const Query& q, double cos_cap, Hits& hits) {
    Candidate c;
    if (vertex_contact(model, v, q, c) && c.cosine >= cos_cap) hits.add(c);
}

inline void test_leaf(const Model& model, std::size_t index, const Query& q, const NodeQuery& nq,
                      double cos_cap, Hits& hits) {
    const Leaf& leaf = model.tree.leaves[index];
    for (unsigned mask = facet_sieve(leaf, nq); mask != 0; mask &= mask - 1) {
        const std::size_t slot = index * lanes + std::size_t(std::countr_zero(mask));
        if (model.tree.face[slot] >= 0) test_facet(model, slot, q, cos_cap, hits);
    }
    for (unsigned mask = vertex_sieve(leaf, nq); mask != 0; mask &= mask - 1) {
        const std::int32_t v = leaf.vertex[std::countr_zero(mask)];
        if (v >= 0) test_vertex(model, v, q, cos_cap, hits);
    }
}

// Leaves met in a descent wait here while their cache lines are on the way.
struct LeafQueue {
    static constexpr int capacity = 16;
    std::int32_t item[capacity];
    int size = 0;
};

}  // namespace detail

// Every facet, then every vertex, one by one and without any sieve: the yardstick for `search`.
inline void exhaust(const Model& model, const Query& q, double cos_cap, Hits& hits) {
    for (std::size_t s = 0; s < model.tree.face.size(); ++s)
        if (model.tree.face[s] >= 0) detail::test_facet(model, s, q, cos_cap, hits);
    for (std::size_t v = 0; v < model.vertices.size(); ++v)
        detail::test_vertex(model, std::int32_t(v), q, cos_cap, hits);
}

// Beyond this moment (in mesh sizes per unit force) single-precision bounds are too coarse to prune.
inline constexpr double far_moment = 1e3;

inline bool prunable(const Query& q) { return norm2(q.m) < far_moment * far_moment; }

// Tests every leaf that `source(leaf_callback)` names. `nq` must belong to `q` and `cos_cap`.
template <class Source>
inline void test_leaves(const Model& model, const Query& q, const NodeQuery& nq, double cos_cap, Hits& hits,
                        Source&& source) {
    detail::LeafQueue queue;
    const auto drain = [&] {
        for (int i = 0; i < queue.size; ++i)
            detail::test_leaf(model, std::size_t(queue.item[i]), q, nq, cos_cap, hits);
        queue.size = 0;
    };
    source([&](std::int32_t leaf) {
        if (queue.size == detail::LeafQueue::capacity) drain();
        queue.item[queue.size++] = leaf;
        const char* lines = reinterpret_cast<const char*>(&model.tree.leaves[std::size_t(leaf)]);
        for (std::size_t i = 0; i < sizeof(Leaf); i += 64) __builtin_prefetch(lines + i);
    });
    drain();
}

inline void search(const Model& model, const Query& q, double cos_cap, Hits& hits) {
    if (!prunable(q)) return exhaust(model, q, cos_cap, hits);
    const NodeQuery nq = make_node_query(q, cos_cap);
    test_leaves(model, q, nq, cos_cap, hits, [&](auto&& leaf) {
        NodeStack stack;
        stack.item[stack.size++] = 0;
        const auto test = [&](const Node& n) { return node_mask(n, nq); };
        descend(model.tree.nodes.data(), stack, test, leaf);
    });
}

}  // namespace contactbench
