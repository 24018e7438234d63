// An eight-wide bounding-volume hierarchy with normal cones: which facets can explain a wrench how well at best.
//
// For a box of points, a cone of normals and the largest mesh errors inside, `node_bound` gives a value that d2 less
// the prior is below nowhere in it. With r = (h, w) as in likelihood.hpp:
//   d2 >= h^2 / (S_ff + (l c)^2) + ((distance of the axis from the box - |w*|)+)^2 / largest V
// with c the largest cosine that a normal of the cone makes with the force, and |w*|, V at their largest, which is at
// the smallest. Over a box with half extents e each component of the axis' offset stays within
// (e_y |f_z| + e_z |f_y|, ...) of the one at its centre. Torsion moves w along the normals alone: across the cone's axis
// V is smaller, and along it a flat patch is thinner than its box. Both tell a wall that the axis passes beside.
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
    std::uint8_t thick[lanes] = {};      // how far it reaches from the centre along the cone's axis, in steps
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

    int level_of(std::int32_t node) const {
        int level = 0;
        while (node >= first[std::size_t(level) + 1]) ++level;
        return level;
    }

    // A node, or ~leaf.
    std::int32_t child(std::int32_t node, int lane) const {
        const int level = level_of(node);
        const std::int32_t nth = lanes * (node - first[std::size_t(level)]) + lane;
        return level == 0 ? ~nth : first[std::size_t(level) - 1] + nth;
    }

    // Bit l is set where there is a child.
    unsigned children(std::int32_t node) const {
        const int level = level_of(node);
        const std::int32_t below = level == 0 ? std::int32_t(leaves.size())
                                              : first[std::size_t(level)] - first[std::size_t(level) - 1];
        const std::int32_t left = below - lanes * (node - first[std::size_t(level)]);
        return left >= lanes ? 0xffu : (1u << left) - 1u;
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

// What a node is tested against.
struct NodeQuery {
    float fx, fy, fz;  // f
    float ax, ay, az, bx, by, bz;
    float mx, my, mz;  // m - h f
    float kx, ky, kz;  // m x f
    float gx, gy, gz;  // |f| by component
    float h, h2, arm2, ff;
    float cos_t;              // friction cone
    float steep;              // of |w*| / (h s), whatever the cosine
    // S across the force: largest eigenvalue at most side + side1 |t - t0| + side2 (t - t0)^2, and
    // |(S_fa, S_fb)| / S_ff at most skew + skew1 |t - t0|.
    float t0, side, side1, side2, skew, skew1;
    float gx0, gy0, gz0, gx1, gy1, gz1;  // g = (S_fa a + S_fb b) / S_ff by depth
    float ga0, gb0, ga1, gb1;            // the same along a and b
    float margin;                        // slack, scaled to this query
};

inline NodeQuery make_node_query(const Query& q, double cos_cap) {
    NodeQuery n{};
    const Form<double>& o = q.form;
    n.fx = float(q.f.x), n.fy = float(q.f.y), n.fz = float(q.f.z);
    n.ax = float(q.a.x), n.ay = float(q.a.y), n.az = float(q.a.z);
    n.bx = float(q.b.x), n.by = float(q.b.y), n.bz = float(q.b.z);
    const Vec3 m = q.m - o.h * q.f;
    n.mx = float(m.x), n.my = float(m.y), n.mz = float(m.z);
    const Vec3 k = cross(q.m, q.f);
    n.kx = float(k.x), n.ky = float(k.y), n.kz = float(k.z);
    n.gx = std::fabs(n.fx), n.gy = std::fabs(n.fy), n.gz = std::fabs(n.fz);
    n.h = float(o.h), n.h2 = n.h * n.h;
    n.arm2 = float(o.arm2), n.ff = float(o.ff);
    n.cos_t = float(std::max(cos_cap, 1e-3));
    const double up = 1.0 + 1e-5;
    n.steep = float(0.5 * up * std::sqrt(o.arm2 / o.ff));
    const auto largest = [](double aa, double ab, double bb) {
        return 0.5 * (aa + bb) + std::sqrt(0.25 * (aa - bb) * (aa - bb) + ab * ab);
    };
    const double grow = o.aa.c[2] + o.bb.c[2];
    const double t0 = grow > 0.0 ? -0.5 * (o.aa.c[1] + o.bb.c[1]) / grow : 0.0;
    const auto slope = [&](const InDepth<double>& d) { return d.c[1] + 2.0 * t0 * d.c[2]; };
    const double da = slope(o.aa), dab = slope(o.ab), db = slope(o.bb);
    n.t0 = float(t0);
    n.side = float(up * largest(o.aa.at(t0), o.ab.at(t0), o.bb.at(t0)));
    n.side1 = float(up * std::max(largest(da, dab, db), largest(-da, -dab, -db)));
    n.side2 = float(up * std::max(0.0, largest(o.aa.c[2], o.ab.c[2], o.bb.c[2])));
    const double fa = o.fa.at(t0), fb = o.fb.at(t0);
    n.skew = float(up * std::sqrt(fa * fa + fb * fb) / o.ff);
    n.skew1 = float(up * std::sqrt(o.fa.c[1] * o.fa.c[1] + o.fb.c[1] * o.fb.c[1]) / o.ff);
    const double c[4] = {o.fa.c[0] / o.ff, o.fb.c[0] / o.ff, o.fa.c[1] / o.ff, o.fb.c[1] / o.ff};
    const Vec3 g0 = c[0] * q.a + c[1] * q.b, g1 = c[2] * q.a + c[3] * q.b;
    n.gx0 = float(g0.x), n.gy0 = float(g0.y), n.gz0 = float(g0.z), n.gx1 = float(g1.x), n.gy1 = float(g1.y), n.gz1 = float(g1.z);
    n.ga0 = float(c[0]), n.gb0 = float(c[1]), n.ga1 = float(c[2]), n.gb1 = float(c[3]);
    n.margin = slack * (1.0f + float(norm(q.m)));
    return n;
}

// A lower bound of d2 in each child.
CONTACTBENCH_INLINE Bounds node_bound(const Node& n, const Boxes& b, const NodeQuery& q) {
    const Float8 cx = b.cx, cy = b.cy, cz = b.cz, ex = b.ex, ey = b.ey, ez = b.ez, zero{}, one = zero + 1.0f;
    const Float8 ix = load8_whole(n.axis[0]), iy = load8_whole(n.axis[1]), iz = load8_whole(n.axis[2]);
    const Float8 shorten = 1.0f / root(ix * ix + iy * iy + iz * iz);
    const Float8 ax = ix * shorten, ay = iy * shorten, az = iz * shorten;
    const Float8 sine = load8_whole(n.sine) * per_sine;
    const Int8 any = sine >= 1.0f;
    const Float8 sin_a = select(any, zero + 1e6f, sine), cos_a = root(larger(one - sine * sine, zero));
    // Cosines between -f and the normals: the largest, and the smallest that the friction cone allows.
    const Float8 back = smaller(larger(-(ax * q.fx + ay * q.fy + az * q.fz), zero - 1.0f), one);
    const Float8 away = root(larger(1.0f - back * back, zero));
    const Float8 high = select(any | (back >= cos_a), one, back * cos_a + away * sin_a + slack);
    const Float8 low = select(any, zero + q.cos_t, larger(back * cos_a - away * sin_a - slack, zero + q.cos_t));
    const Float8 c2 = low * low, s2 = larger(1.0f - c2, zero), s = root(s2);
    const Float8 per_low = 1.00001f / low, per_c2 = per_low * per_low;
    // The covariance at its largest: V = S_w + var n n^T + var c (n g^T + g n^T) - (S_ff - var c^2) g g^T.
    const Float8 t = cx * q.fx + cy * q.fy + cz * q.fz, deep = ex * q.gx + ey * q.gy + ez * q.gz + q.margin;
    const Float8 depth = magnitude(t - q.t0) + deep;
    const Float8 skew = q.skew + depth * q.skew1, share = 1.00001f * q.ff / (q.ff + q.arm2 * c2);
    Bounds bound;
    const Float8 plain = q.side + depth * (q.side1 + depth * q.side2) + upper_half(n.bend) * q.h2 * per_c2 + upper_half(n.spread);
    bound.V = plain + q.arm2 * smaller(share * s * (s + 2.0f * skew), s2);
    const float h = std::fabs(q.h);
    const Float8 reach = (h * 1.0001f) * (skew * share + smaller(s * per_low, s * q.steep));
    // w* is g h S_ff / (S_ff + arm^2 c^2) - h beta n across f, g = (S_fa, S_fb) / S_ff, beta = arm^2 c / (S_ff + arm^2 c^2) <= 1 / c: for
    // the cone's axis, and how far from it for its other normals. Where the cone is wide, anywhere within reach.
    const Float8 axis_c = larger(back, low);
    const Float8 beta = q.arm2 * axis_c / (q.ff + q.arm2 * axis_c * axis_c);
    const Float8 turn = 1.42f * sin_a + slack;  // >= 2 sin(a / 2)
    const Float8 round = h * (q.skew1 * deep * share + turn * (per_low + per_c2 + 0.5f * skew * per_low));
    const Int8 narrow = (round < reach) & (back >= q.cos_t);
    const Float8 hb = select(narrow, q.h * beta, zero), hg = select(narrow, q.h * (1.0f - axis_c * beta), zero);
    bound.near = select(narrow, round, reach);
    bound.wa = hg * (q.ga0 + t * q.ga1) - hb * (ax * q.ax + ay * q.ay + az * q.az);
    bound.wb = hg * (q.gb0 + t * q.gb1) - hb * (ax * q.bx + ay * q.by + az * q.bz);
    // How far the axis, or where on a facet it would be, passes the box.
    const Float8 wx = hb * (ax + back * q.fx) - hg * (q.gx0 + t * q.gx1);
    const Float8 wy = hb * (ay + back * q.fy) - hg * (q.gy0 + t * q.gy1);
    const Float8 wz = hb * (az + back * q.fz) - hg * (q.gz0 + t * q.gz1);
    const Float8 x = q.mx - (cy * q.fz - cz * q.fy) + wx, y = q.my - (cz * q.fx - cx * q.fz) + wy,
                 z = q.mz - (cx * q.fy - cy * q.fx) + wz;
    const Float8 vx = magnitude(x) - (ey * q.gz + ez * q.gy) - q.margin;
    const Float8 vy = magnitude(y) - (ez * q.gx + ex * q.gz) - q.margin;
    const Float8 vz = magnitude(z) - (ex * q.gy + ey * q.gx) - q.margin;
    const Float8 px = larger(vx, zero), py = larger(vy, zero), pz = larger(vz, zero);
    const Float8 miss = larger(root(px * px + py * py + pz * pz) - bound.near, zero);
    // V <= S + arm2 n n^T, as to know h takes from what torsion adds, and n is at most s along the part of the cone's axis across
    // f, and `turned` along u, across both. As (a + b)^2 <= (1 + turned / s) a^2 + (1 + s / turned) b^2, V is no larger than
    // V_n along the one and V_u along the other.
    const Float8 turned = smaller(turn, s), per_away = 1.0f / larger(away, zero + 0.25f);
    const Float8 sx = ax + back * q.fx, sy = ay + back * q.fy, sz = az + back * q.fz;
    const Float8 box = ex * magnitude(sx) + ey * magnitude(sy) + ez * magnitude(sz);
    const Float8 slab = load8_whole(n.thick) * n.step + magnitude(back) * (deep - q.margin);
    const Float8 beside = magnitude(ax * q.kx + ay * q.ky + az * q.kz + cx * sx + cy * sy + cz * sz) - smaller(box, slab);
    const Float8 reach_u = (h * 1.0001f) * (skew * share + turned * smaller(per_low, zero + q.steep));
    const Float8 miss_u = larger(beside * per_away - reach_u - 8.0f * q.margin, zero);
    const Float8 along = magnitude(x * sx + y * sy + z * sz) -
                         (ex * magnitude(q.fy * az - q.fz * ay) + ey * magnitude(q.fz * ax - q.fx * az) +
                          ez * magnitude(q.fx * ay - q.fy * ax));
    const Float8 miss_n = larger(along * per_away - bound.near - 8.0f * q.margin, zero);
    const Float8 both = q.arm2 * (s + turned), V_u = plain + both * turned, V_n = plain + both * s;
    const Float8 most = smaller(high * high, one);
    bound.d2 = (q.h2 / (q.ff + q.arm2 * most) + larger(miss * miss / bound.V, miss_u * miss_u / V_u + miss_n * miss_n / V_n)) *
               (1.0f - 1e-4f);
    bound.faces_force = high >= q.cos_t - slack;
    return bound;
}

CONTACTBENCH_INLINE void corners_of(const Leaf& leaf, Float8 (&p)[3][3]) {
    for (int c = 0; c < 3; ++c)
        for (int i = 0; i < 3; ++i) p[c][i] = load8_whole(leaf.corner[c][i]) * leaf.step + leaf.low[i];
}

// A lower bound of d2 on each facet of a leaf, whose corners are `p`.
CONTACTBENCH_INLINE Bounds leaf_bound(const Leaf& leaf, const Float8 (&p)[3][3], const Form<float>& form, const NodeQuery& q) {
    Float8 n[3];
    for (int i = 0; i < 3; ++i) n[i] = load8(leaf.normal[i]);
    // Rounded corners move w by a step, and the depth at which the axis meets a facet by a step over the cosine; that moves
    // w*, and V = |v(t)|^2 <= (1 + 1e-3) |v(t')|^2 + 1001 |v'|^2 (t - t')^2, as v is linear in t.
    const float depth = leaf.step * (1.0f + 1.0f / q.cos_t), h = std::fabs(q.h);
    const float margin = 4.0f * (q.margin + leaf.step) + 8.0f * q.skew1 * h * depth;
    const float loose = 1001.0f * depth * depth * (q.side2 + q.arm2 * q.skew1 * q.skew1);
    return bound_facets(p, n, {Float8{} + leaf.spread, Float8{} + leaf.bend}, form, q.cos_t, margin, loose);
}

}  // namespace contactbench
