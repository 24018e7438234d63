// An eight-wide bounding-volume hierarchy with normal cones: which facets can explain a wrench how well at best.
//
// For a box of points, a cone of normals and the largest mesh errors inside, `node_bound` gives a value that d2 less
// the prior is below nowhere in it. With r = (h, w) as in likelihood.hpp:
//   d2 >= h^2 / (S_ff + (l c)^2) + ((distance of the axis from the box - |w*|)+)^2 / largest V
// with c the largest cosine that a normal of the cone makes with the force, and |w*|, V at their largest, which is at
// the smallest. Over a box with half extents e each component of the axis' offset stays within
// (e_y |f_z| + e_z |f_y|, ...) of the one at its centre.
//
// Contract
//   units      dimensionless (see likelihood.hpp); bounds are single precision, rounded outwards, and every test keeps
//              `slack` in hand, so a node is never dropped that holds what is looked for: guarded by the tests that
//              compare the search with every facet looked at one by one.
//   order      facets are permuted into blocks of eight; a subtree is a contiguous range of blocks.
//   complexity construction O(n log n) time, O(n) memory, allocates; a search allocates nothing.
#pragma once

#include <bit>

#include "likelihood.hpp"
#include "topology.hpp"

namespace contactbench {

// Bounds of eight children, structure-of-arrays. Unused lanes have child == empty_child.
struct alignas(64) Node {
    float cx[lanes] = {}, cy[lanes] = {}, cz[lanes] = {};  // box centre
    float ex[lanes] = {}, ey[lanes] = {}, ez[lanes] = {};  // box half extents
    float ax[lanes] = {}, ay[lanes] = {}, az[lanes] = {};  // cone axis
    float cos_a[lanes] = {}, sin_a[lanes] = {};            // cone half angle
    float spread[lanes] = {}, bend[lanes] = {};            // largest MeshError inside
    float bonus[lanes] = {};                               // largest prior inside
    std::int32_t child[lanes] = {};                        // node, or ~leaf for a leaf
};

inline constexpr std::int32_t empty_child = std::numeric_limits<std::int32_t>::max();
inline constexpr float slack = 2e-6f;  // eight times the worst rounding of the tests below

// What a node is tested against.
struct NodeQuery {
    float fx, fy, fz;  // f
    float ax, ay, az, bx, by, bz;
    float mx, my, mz;  // m - h f
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
CONTACTBENCH_INLINE Bounds node_bound(const Node& n, const NodeQuery& q) {
    const Float8 cx = load8(n.cx), cy = load8(n.cy), cz = load8(n.cz);
    const Float8 ex = load8(n.ex), ey = load8(n.ey), ez = load8(n.ez);
    const Float8 ax = load8(n.ax), ay = load8(n.ay), az = load8(n.az);
    const Float8 zero{}, one = zero + 1.0f, cos_a = load8(n.cos_a), sin_a = load8(n.sin_a);
    // Cosines between -f and the normals: the largest, and the smallest that the friction cone allows.
    const Float8 back = smaller(larger(-(ax * q.fx + ay * q.fy + az * q.fz), zero - 1.0f), one);
    const Float8 away = root(larger(1.0f - back * back, zero));
    const Int8 any = sin_a > 2.0f;  // the normals fill more than a half space
    const Float8 high = select(any | (back >= cos_a), one, back * cos_a + away * sin_a + slack);
    const Float8 low = select(any, zero + q.cos_t, larger(back * cos_a - away * sin_a - slack, zero + q.cos_t));
    const Float8 c2 = low * low, s2 = larger(1.0f - c2, zero), s = root(s2);
    const Float8 per_low = 1.00001f / low, per_c2 = per_low * per_low;
    // The covariance at its largest: V = S_w + var n n^T + var c (n g^T + g n^T) - (S_ff - var c^2) g g^T.
    const Float8 t = cx * q.fx + cy * q.fy + cz * q.fz, deep = ex * q.gx + ey * q.gy + ez * q.gz + q.margin;
    const Float8 depth = magnitude(t - q.t0) + deep;
    const Float8 skew = q.skew + depth * q.skew1, share = 1.00001f * q.ff / (q.ff + q.arm2 * c2);
    Bounds bound;
    bound.V = q.side + depth * (q.side1 + depth * q.side2) + load8(n.bend) * q.h2 * per_c2 + load8(n.spread) +
              q.arm2 * share * s * (s + 2.0f * skew);
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
    const Float8 vx = magnitude(q.mx - (cy * q.fz - cz * q.fy) + wx) - (ey * q.gz + ez * q.gy) - q.margin;
    const Float8 vy = magnitude(q.my - (cz * q.fx - cx * q.fz) + wy) - (ez * q.gx + ex * q.gz) - q.margin;
    const Float8 vz = magnitude(q.mz - (cx * q.fy - cy * q.fx) + wz) - (ex * q.gy + ey * q.gx) - q.margin;
    const Float8 px = larger(vx, zero), py = larger(vy, zero), pz = larger(vz, zero);
    const Float8 miss = larger(root(px * px + py * py + pz * pz) - bound.near, zero);
    const Float8 most = smaller(high * high, one);
    bound.d2 = (q.h2 / (q.ff + q.arm2 * most) + miss * miss / bound.V) * (1.0f - 1e-4f);
    bound.faces_force = high >= q.cos_t - slack;
    return bound;
}

}  // namespace contactbench
