// An eight-wide bounding-volume hierarchy with normal cones: which facets can hold the contact at all.
//
// A contact at p needs its normal along u(p) = v(p) - |h| f, where v(p) = -sign(h) (m - h f - p x f) is
// the offset of p from the wrench axis turned by a right angle. v is affine in p: over a box with
// centre c and half extents e each component of it stays within t = (e_y |f_z| + e_z |f_y|, ...) of
// v(c). So the required normals form a cone, which the node's own cone of normals must meet; that test
// alone is complete for any pitch and angle. With a friction cap theta the contact also lies within
// |h| tan(theta) of the axis, which makes |v_x| <= t_x + |h| tan(theta) and so on (with h = 0 the
// separating-axis test of a line against a box), and its normal within theta of -f.
//
// Contract
//   units      dimensionless (see facets.hpp); bounds are single precision, rounded outwards, and every
//              test keeps `slack` in hand, so a node is never dropped that holds an accepted facet.
//   order      facets are permuted into blocks of eight; a subtree is a contiguous range of blocks.
//   complexity construction O(n log n) time, O(n) memory, allocates; a search is O(log n) for a
//              bounded pitch and allocates nothing.
#pragma once

#include <bit>

#include "facets.hpp"
#include "pack.hpp"

namespace contactbench {

// Bounds of eight children, structure-of-arrays. Unused lanes have child == empty_child.
struct alignas(64) Node {
    float cx[lanes] = {}, cy[lanes] = {}, cz[lanes] = {};  // box centre
    float ex[lanes] = {}, ey[lanes] = {}, ez[lanes] = {};  // box half extents
    float ax[lanes] = {}, ay[lanes] = {}, az[lanes] = {};  // cone axis
    float radius[lanes] = {};                              // of the box's corners about its centre
    float cos2_a[lanes] = {}, cos_a[lanes] = {}, sin_a[lanes] = {};  // cone half angle
    float rank[lanes] = {};                                // highest priority region inside
    std::int32_t child[lanes] = {};                        // node, or ~leaf for a leaf
};

inline constexpr std::int32_t empty_child = std::numeric_limits<std::int32_t>::max();
inline constexpr float slack = 2e-6f;  // eight times the worst rounding of the tests below at |u| <= 4

// What a node is tested against. `reach` widens the tests: to contacts that miss the axis by as much.
struct NodeQuery {
    float fx, fy, fz;           // sign * f, so that v = m + c x f with the next line
    float mx, my, mz;           // -sign * (m - h f)
    float qx, qy, qz;           // m
    float ox, oy, oz;           // f
    float gx, gy, gz;           // |f| by component
    float nx, ny, nz;           // -f
    float h, h2, capsule;       // |h|, h^2 and |h| tan(theta); capsule is huge without a cap
    float cos_t, sin_t;         // the cap
    float reach = 0.0f;         // how far v and u may be off
    float margin = 0.0f;        // slack, scaled to this query
};

// The side on which a push must lie: n = -sign(h) (m - p x f) / |...|. With h == 0 contact is on the
// axis itself, where either sign will do.
inline double push_sign(const Query& q) { return q.h < 0.0 ? -1.0 : 1.0; }

inline NodeQuery make_node_query(const Query& q, double cos_cap) {
    NodeQuery n{};
    const double sign = push_sign(q);
    const Vec3 f = sign * q.f, m = -sign * (q.m - q.h * q.f);
    n.fx = float(f.x), n.fy = float(f.y), n.fz = float(f.z);
    n.mx = float(m.x), n.my = float(m.y), n.mz = float(m.z);
    n.qx = float(q.m.x), n.qy = float(q.m.y), n.qz = float(q.m.z);
    n.ox = float(q.f.x), n.oy = float(q.f.y), n.oz = float(q.f.z);
    n.gx = std::fabs(n.fx), n.gy = std::fabs(n.fy), n.gz = std::fabs(n.fz);
    n.nx = float(-q.f.x), n.ny = float(-q.f.y), n.nz = float(-q.f.z);
    n.h = float(std::fabs(q.h)), n.h2 = n.h * n.h;
    const double c = std::max(cos_cap, 0.0), s = std::sqrt(std::max(0.0, 1.0 - c * c));
    n.cos_t = float(c), n.sin_t = float(s);
    n.capsule = c > 1e-6 ? float(std::fabs(q.h) * s / c) : 1e15f;
    n.margin = slack * (1.0f + float(norm(q.m)));
    return n;
}


// Bit l is set when child l may hold a contact of the wrench. Never clears a bit it should not:
// guarded by the tests that compare the search with the exhaustive scan, facet for facet.
CONTACTBENCH_INLINE unsigned node_mask(const Node& n, const NodeQuery& q) {
    const Float8 cx = load8(n.cx), cy = load8(n.cy), cz = load8(n.cz);
    const Float8 ex = load8(n.ex), ey = load8(n.ey), ez = load8(n.ez);
    const Float8 ax = load8(n.ax), ay = load8(n.ay), az = load8(n.az);
    const Float8 sin_a = load8(n.sin_a);
    const Float8 vx = q.mx + (cy * q.fz - cz * q.fy);
    const Float8 vy = q.my + (cz * q.fx - cx * q.fz);
    const Float8 vz = q.mz + (cx * q.fy - cy * q.fx);
    // The box against the capsule, by component.
    const Float8 tx = ey * q.gz + ez * q.gy;
    const Float8 ty = ez * q.gx + ex * q.gz;
    const Float8 tz = ex * q.gy + ey * q.gx;
    const Float8 slab = smaller(smaller(tx - magnitude(vx), ty - magnitude(vy)), tz - magnitude(vz)) +
                        (q.capsule + q.reach + q.margin);
    // Its normals against the friction cone.
    const Float8 back = ax * q.nx + ay * q.ny + az * q.nz;
    const Float8 front = back - (load8(n.cos_a) * q.cos_t - sin_a * q.sin_t) + q.margin;
    // Its normals against the required ones: a . u + sin(a) r >= cos(a) sqrt(u^2 - r^2), squared.
    const Float8 ball = load8(n.radius) + (q.reach + q.margin);
    const Float8 clear2 = ((vx * vx + vy * vy + vz * vz) + q.h2) - ball * ball;  // < 0: any direction
    const Float8 along = (ax * vx + ay * vy + az * vz) + q.h * back + sin_a * ball + q.margin;
    const Float8 cone = along * magnitude(along) - load8(n.cos2_a) * clear2;
    return nonnegative(smaller(smaller(larger(cone, -clear2), front), slab));
}

// Depth-first over the nodes that may hold a contact; `leaf(block)` is called for each leaf reached.
// 8-wide and balanced: depth is at most 11 for 2^29 facets, so the stack cannot overflow.
struct NodeStack {
    std::int32_t item[lanes * 12];
    int size = 0;
};

template <class Leaf>
inline void push_children(const Node* nodes, const Node& node, unsigned mask, NodeStack& stack, Leaf&& leaf) {
    for (; mask != 0; mask &= mask - 1) {
        const std::int32_t child = node.child[std::countr_zero(mask)];
        if (child == empty_child) continue;
        if (child < 0) {
            leaf(~child);
        } else {
            stack.item[stack.size++] = child;
            for (std::size_t i = 0; i < sizeof(Node); i += 64)
                __builtin_prefetch(reinterpret_cast<const char*>(nodes + child) + i);
        }
    }
}

template <class Test, class Leaf>
inline void descend(const Node* nodes, NodeStack& stack, Test&& test, Leaf&& leaf) {
    while (stack.size > 0) {
        const Node& node = nodes[stack.item[--stack.size]];
        push_children(nodes, node, test(node), stack, leaf);
    }
}

}  // namespace contactbench
