// An eight-wide bounding-volume hierarchy with normal cones: which facets can explain a wrench how well at best.
//
// For a box of points, a cone of normals and the largest mesh errors inside, `node_bound` gives a value that d2 less
// the prior is below nowhere in it. With r = (h, w) as in likelihood.hpp:
//   d2 >= h^2 / (S_ff + (l c)^2) + ((distance of the axis from the box - |w*|)+)^2 / largest V
// with c the largest cosine that a normal of the cone makes with the force, and |w*|, V at their largest, which is at
// the smallest. Over a box with half extents e each component of the axis' offset stays within
// (e_y |f_z| + e_z |f_y|, ...) of the one at its centre. That torsion moves w along the normals alone is left to the facets: what
// it saves here, of nodes, is less than it takes.
//
// Contract
//   units      dimensionless (see likelihood.hpp); bounds are small whole numbers and single precision, rounded outwards,
//              and every test keeps `slack` in hand, so a node is never dropped that holds what is looked for: guarded
//              by the tests that compare the search with every facet looked at one by one.
//   order      facets are permuted into blocks of eight; a subtree is a contiguous range of blocks. Nodes lie level by
//              level, the lowest first; all are full but the last of each level, so no child needs to be named.
//   complexity construction O(n log n) time, O(n) memory, allocates; a search allocates nothing.
#pragma once

#include <array>
#include <bit>

#include "likelihood.hpp"
#include "topology.hpp"

namespace contactbench {

// Bounds of eight children, structure-of-arrays: two lines of cache.
struct alignas(64) Node {
    std::int16_t centre[3][lanes] = {};  // of the box, over 32767
    std::uint8_t half[3][lanes] = {};    // its half extents, in steps
    std::int8_t axis[3][lanes] = {};     // of the cone of normals, of some length
    std::uint8_t sine[lanes] = {};       // of its half angle, over 255, which stands for every normal
    std::uint8_t bonus[lanes] = {};      // largest prior inside: see Priors
    float step = 0.0f;
    std::uint16_t spread = 0, bend = 0;  // largest MeshError of all children: the upper half of a float
};
static_assert(sizeof(Node) == 128);

// Eight facets: what is looked at before a facet in full.
struct alignas(16) Leaf {
    std::uint16_t corner[3][3][lanes] = {};  // [corner][axis][lane], in steps from `low`
    float normal[3][lanes] = {};
    std::uint8_t bonus[lanes] = {};
    float low[3] = {}, step = 0.0f;
    float spread = 0.0f, bend = 0.0f;  // largest MeshError inside
};
static_assert(sizeof(Leaf) == 272);

// Priors in 255 steps from the least to the largest of a model, rounded up.
struct Priors {
    float least = 0.0f, step = 0.0f;

    CONTACTBENCH_INLINE Float8 of(const std::uint8_t* bonus) const { return load8_whole(bonus) * step + least; }
};

struct Hierarchy {
    std::vector<Node> nodes;         // by level, the lowest first; the last is the root
    std::vector<Leaf> leaves;        // each stands for eight slots
    std::vector<std::int32_t> face;  // slot -> face number of the input, -1 for padding
    // Nodes of the levels below each, and of all; as many as it takes to eight to that power beyond any mesh.
    std::array<std::int32_t, 14> first{};
    Priors priors;

    std::int32_t root() const { return std::int32_t(nodes.size()) - 1; }

    // More than a processor keeps at hand.
    bool large() const { return leaves.size() > 1024; }

    int level_of(std::int32_t node) const {
        int level = 0;
        while (node >= first[std::size_t(level) + 1]) ++level;
        return level;
    }

    // Of a node: lane l is number first + l of the level below, where bit l of `which` is set; of the leaves below level 0.
    struct Children {
        std::int32_t first;
        unsigned which;
    };

    Children children(std::int32_t node, int level) const {
        const std::int32_t begin = level == 0 ? 0 : first[std::size_t(level) - 1];
        const std::int32_t end = level == 0 ? std::int32_t(leaves.size()) : first[std::size_t(level)];
        const std::int32_t child = begin + lanes * (node - first[std::size_t(level)]), left = end - child;
        return {child, left >= lanes ? 0xffu : (1u << left) - 1u};
    }
};

inline constexpr float slack = 2e-6f;  // eight times the worst rounding of the tests below
inline constexpr float per_centre = 1.0f / 32767.0f, per_sine = 1.0f / 255.0f;
inline constexpr std::uint8_t every_normal = 255;

CONTACTBENCH_INLINE float upper_half(std::uint16_t bits) { return std::bit_cast<float>(std::uint32_t(bits) << 16); }

// The boxes of a node's children.
struct Boxes {
    Float8 cx, cy, cz, ex, ey, ez;
};

CONTACTBENCH_INLINE Boxes boxes_of(const Node& n) {
    return {load8_whole(n.centre[0]) * per_centre, load8_whole(n.centre[1]) * per_centre,
            load8_whole(n.centre[2]) * per_centre, load8_whole(n.half[0]) * n.step,
            load8_whole(n.half[1]) * n.step,       load8_whole(n.half[2]) * n.step};
}

// What a node is tested against; each number in every lane, so that it is read where it is used.
struct NodeQuery {
    Float8 fx, fy, fz;  // f
    Float8 gx, gy, gz;  // |f| by component
    Float8 mx, my, mz;  // m - h f
    Float8 h, h2, arm2, ff;
    Float8 cos_t, sin_t;  // friction cone
    Float8 steep;  // of |w*| / s, whatever the cosine
    // S across the force: largest eigenvalue at most side + side1 |t - t0| + side2 (t - t0)^2, and
    // |(S_fa, S_fb)| / S_ff at most skew + skew1 |t - t0|.
    Float8 t0, side, side1, side2, skew, skew1;
    Float8 margin;  // slack, scaled to this query
    Float8 give;    // what rounding may take from V
    float moves, widens;  // what a step of a leaf's corners moves w* by, and its square V
};

inline NodeQuery make_node_query(const Query& q, double cos_cap) {
    NodeQuery n;
    const auto all = [](double x) { return Float8{} + float(x); };
    const Form<double>& o = q.form;
    n.fx = all(q.f.x), n.fy = all(q.f.y), n.fz = all(q.f.z);
    n.gx = magnitude(n.fx), n.gy = magnitude(n.fy), n.gz = magnitude(n.fz);
    const Vec3 m = q.m - o.h * q.f;
    n.mx = all(m.x), n.my = all(m.y), n.mz = all(m.z);
    const double cos_t = std::max(cos_cap, 1e-3), h = std::fabs(o.h), up = 1.0 + 1e-5;
    n.h = all(1.0001 * h), n.h2 = all(o.h * o.h), n.arm2 = all(o.arm2), n.ff = all(o.ff),
    n.cos_t = all(cos_t), n.sin_t = all(std::sqrt(1.0 - cos_t * cos_t) + slack);
    n.steep = all(0.5001 * h * std::sqrt(o.arm2 / o.ff));
    const auto largest = [](double aa, double ab, double bb) {
        return 0.5 * (aa + bb) + std::sqrt(0.25 * (aa - bb) * (aa - bb) + ab * ab);
    };
    const double grow = o.aa.c[2] + o.bb.c[2];
    const double t0 = grow > 0.0 ? -0.5 * (o.aa.c[1] + o.bb.c[1]) / grow : 0.0;
    const auto slope = [&](const InDepth<double>& d) { return d.c[1] + 2.0 * t0 * d.c[2]; };
    const double da = slope(o.aa), dab = slope(o.ab), db = slope(o.bb);
    const double side2 = up * std::max(0.0, largest(o.aa.c[2], o.ab.c[2], o.bb.c[2]));
    n.t0 = all(t0);
    n.side = all(up * largest(o.aa.at(t0), o.ab.at(t0), o.bb.at(t0)));
    n.side1 = all(up * std::max(largest(da, dab, db), largest(-da, -dab, -db)));
    n.side2 = all(side2);
    const double fa = o.fa.at(t0), fb = o.fb.at(t0);
    const double skew1 = up * std::sqrt(o.fa.c[1] * o.fa.c[1] + o.fb.c[1] * o.fb.c[1]) / o.ff;
    n.skew = all(up * std::sqrt(fa * fa + fb * fb) / o.ff), n.skew1 = all(skew1);
    n.margin = all(slack * (1.0 + norm(q.m)));
    // V is a sum of terms that may cancel, less what h tells of w: no more exact than the largest of them.
    constexpr double far = 1.75;  // > sqrt(3)
    const double told = o.fa.terms(far) + o.fb.terms(far);
    n.give = all(1e-6 * (o.aa.terms(far) + o.bb.terms(far) + told * told / o.ff));
    const double deep = up * (1.0 + 1.0 / cos_t);
    n.moves = float(8.0 * up * skew1 * h * deep);
    n.widens = float(1001.0 * up * deep * deep * (side2 + o.arm2 * skew1 * skew1));
    return n;
}

// A lower bound of d2 in each child.
CONTACTBENCH_INLINE Bounds node_bound(const Node& n, const Boxes& b, const NodeQuery& q) {
    const Float8 cx = b.cx, cy = b.cy, cz = b.cz, ex = b.ex, ey = b.ey, ez = b.ez, zero{}, one = zero + 1.0f;
    const Float8 ix = load8_whole(n.axis[0]), iy = load8_whole(n.axis[1]), iz = load8_whole(n.axis[2]);
    const Float8 sine = load8_whole(n.sine) * per_sine, cos_a = root(larger(one - sine * sine, zero));
    // Cosines between -f and the normals: the largest, and the smallest that the friction cone allows.
    const Float8 turned = (ix * q.fx + iy * q.fy + iz * q.fz) / root(ix * ix + iy * iy + iz * iz);
    const Float8 back = smaller(larger(-turned, zero - 1.0f), one), away = root(1.000001f - back * back);  // 1: as rounded
    const Float8 high = select((sine >= one) | (back >= cos_a), one, smaller(back * cos_a + away * sine + slack, one));
    const Float8 inside = back * cos_a - away * sine - slack, low = larger(inside, q.cos_t), c2 = low * low, per_low = 1.00001f / low;
    const Float8 s = select(inside > q.cos_t, away * cos_a + back * sine + slack, q.sin_t);
    // The covariance at its largest: V = S_w + var n n^T + var c (n g^T + g n^T) - (S_ff - var c^2) g g^T.
    const Float8 deep = ex * q.gx + ey * q.gy + ez * q.gz + q.margin;
    const Float8 depth = magnitude(cx * q.fx + cy * q.fy + cz * q.fz - q.t0) + deep;
    const Float8 skew = q.skew + depth * q.skew1, share = 1.00001f * q.ff / (q.ff + q.arm2 * c2);
    Bounds bound;
    bound.V = q.side + depth * (q.side1 + depth * q.side2) + upper_half(n.bend) * q.h2 * (per_low * per_low) +
              upper_half(n.spread) + q.arm2 * smaller(share * s * (s + 2.0f * skew), s * s);
    // w* is g h S_ff / (S_ff + arm^2 c^2) - h beta n across f, g = (S_fa, S_fb) / S_ff, beta = arm^2 c / (S_ff + arm^2 c^2) <= 1 / c.
    bound.wa = bound.wb = zero;
    bound.near = q.h * (skew * share) + s * smaller(q.h * per_low, q.steep);
    // How far the axis passes the box.
    const Float8 x = q.mx - (cy * q.fz - cz * q.fy), y = q.my - (cz * q.fx - cx * q.fz), z = q.mz - (cx * q.fy - cy * q.fx);
    const Float8 vx = larger(magnitude(x) - (ey * q.gz + ez * q.gy) - q.margin, zero);
    const Float8 vy = larger(magnitude(y) - (ez * q.gx + ex * q.gz) - q.margin, zero);
    const Float8 vz = larger(magnitude(z) - (ex * q.gy + ey * q.gx) - q.margin, zero);
    const Float8 miss = larger(root(vx * vx + vy * vy + vz * vz) - bound.near, zero);
    bound.d2 = (q.h2 / (q.ff + q.arm2 * (high * high)) + miss * miss / bound.V) * (1.0f - 1e-4f);
    bound.d2 = select(high >= q.cos_t - slack, bound.d2, zero + no_touch);
    return bound;
}

CONTACTBENCH_INLINE Facets facets_of(const Leaf& leaf, const Form<Float8>& form) {
    Facets of;
    for (int c = 0; c < 3; ++c) {
        for (int i = 0; i < 3; ++i) of.p[c][i] = load8_whole(leaf.corner[c][i]) * leaf.step + leaf.low[i];
        of.wa[c] = form.ma - along(of.p[c], form.b), of.wb[c] = form.mb + along(of.p[c], form.a);
    }
    for (int i = 0; i < 3; ++i) of.n[i] = load8(leaf.normal[i]);
    of.cosine = -along(of.n, form.f);
    return of;
}

// A lower bound of d2 on each facet of a leaf.
CONTACTBENCH_INLINE Bounds leaf_bound(const Leaf& leaf, const Form<Float8>& form, const NodeQuery& q, float most) {
    // Rounded corners move w by a step, and the depth at which the axis meets a facet by a step over the cosine; that moves
    // w*, and V = |v(t)|^2 <= (1 + 1e-3) |v(t')|^2 + 1001 |v'|^2 (t - t')^2, as v is linear in t.
    const Float8 margin = 4.0f * (q.margin + leaf.step) + leaf.step * q.moves, loose = q.give + leaf.step * leaf.step * q.widens;
    const MeshError<Float8> error{Float8{} + leaf.spread, Float8{} + leaf.bend};
    return bound_facets(facets_of(leaf, form), error, form, q.cos_t, margin, loose, most);
}

}  // namespace contactbench
