// Could noise have hidden the true contact? Near the rim of a non-convex probe the measured axis can
// miss the touched face by a hair and go on to hit another part tens of millimetres away, alone and
// plausible. So: is there a facet, far from the chosen point, that would accept the wrench if it were
// off by no more than z sigma, and by no much larger local torque than the chosen one?
//
// Contract: S frame, SI. The answer is conservative (each edge may use its own z sigma). O(log n): the
// nodes that the widened axis meets far from the chosen point; on a convex probe not needed at all.
#pragma once

#include "choice.hpp"
#include "covariance.hpp"
#include "search.hpp"

namespace contactbench {

struct RivalSearch {
    double sigmas = 3.0;
    double clearance = 0.0;  // m: nearer than this is no rival but the same contact
    double cos_friction = 0.0;  // a rival's friction angle is at most this; > 0
};

namespace detail {

// Variance of w (normalised) on an edge. In S units w = M . b + F . c with b = scale e and
// c = scale (scale c_n + centre x e).
inline double edge_variance(const double edge[6], const Model& m, const Query& q,
                            const WrenchCovariance& noise) {
    const Vec3 e{edge[0], edge[1], edge[2]}, moment{edge[3], edge[4], edge[5]};
    const Vec3 c = m.frame.scale * moment + cross(m.frame.centre, e);
    const double g[6] = {c.x, c.y, c.z, e.x, e.y, e.z};
    double sum = 0.0;
    for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 6; ++j) sum += g[i] * noise.s[i][j] * g[j];
    const double unit = q.force * m.frame.scale;
    return sum / (unit * unit);
}

// `miss`: by how many sigma the worst edge refuses.
inline bool nearly_accepts(const Model& m, std::size_t slot, const Query& q, const WrenchCovariance& noise,
                           double sigmas, Candidate& out, double& miss) {
    const FacetEdges& facet = m.tree.edges[slot];
    double w[3];
    EdgeMoments exact;
    if (accepts(facet, m.tree.triangle[slot], q, exact)) return false;  // a candidate already
    double worst = 0.0;  // squared
    for (int e = 0; e < 3; ++e) {
        w[e] = exact.w[e];
        if (w[e] <= 0.0) continue;
        const double variance = edge_variance(facet.edge[e], m, q, noise);
        if (!(w[e] * w[e] <= sigmas * sigmas * variance)) return false;
        worst = std::max(worst, w[e] * w[e] / variance);
    }
    miss = std::sqrt(worst);
    for (double& value : w) value = std::min(value, 0.0);
    if (w[0] + w[1] + w[2] >= 0.0) w[0] = w[1] = w[2] = -1.0;
    out = facet_contact(m, slot, w, q);  // the point of the facet next to where the axis passed
    return true;
}

// Bit l is set when part of child l lies further than `radius` from the point, and part of it within
// the capsule: node_mask takes that by component, which is loose where the capsule is wide.
CONTACTBENCH_INLINE unsigned rival_mask(const Node& n, const NodeQuery& q, const float point[3], float radius) {
    const Float8 cx = load8(n.cx), cy = load8(n.cy), cz = load8(n.cz);
    const Float8 ex = load8(n.ex), ey = load8(n.ey), ez = load8(n.ez);
    const Float8 dx = magnitude(cx - point[0]) + ex, dy = magnitude(cy - point[1]) + ey,
                 dz = magnitude(cz - point[2]) + ez;
    const Float8 beyond = (dx * dx + dy * dy + dz * dz) - radius * radius;
    const Float8 vx = q.mx + (cy * q.fz - cz * q.fy);
    const Float8 vy = q.my + (cz * q.fx - cx * q.fz);
    const Float8 vz = q.mz + (cx * q.fy - cy * q.fx);
    const Float8 wide = load8(n.radius) + (q.capsule + q.reach + q.margin);
    return nonnegative(smaller(beyond, wide * wide - (vx * vx + vy * vy + vz * vz)));
}

// Facets of the leaf with a corner further than `radius` from the point and facing the force.
CONTACTBENCH_INLINE unsigned rival_sieve(const Leaf& leaf, const NodeQuery& q, const float point[3], float radius) {
    Float8 p[3][3], farthest{};
    for (int c = 0; c < 3; ++c) {
        for (int i = 0; i < 3; ++i) p[c][i] = load8(leaf.corner[c][i]);
        const Float8 dx = p[c][0] - point[0], dy = p[c][1] - point[1], dz = p[c][2] - point[2];
        farthest = larger(farthest, dx * dx + dy * dy + dz * dz);
    }
    const Float8 ax = p[1][0] - p[0][0], ay = p[1][1] - p[0][1], az = p[1][2] - p[0][2];
    const Float8 bx = p[2][0] - p[0][0], by = p[2][1] - p[0][1], bz = p[2][2] - p[0][2];
    const Float8 nx = ay * bz - az * by, ny = az * bx - ax * bz, nz = ax * by - ay * bx;
    const Float8 push = nx * q.nx + ny * q.ny + nz * q.nz;
    const Float8 facing = push * magnitude(push) - (0.98f * q.cos_t * q.cos_t) * (nx * nx + ny * ny + nz * nz);
    return nonnegative(smaller(farthest - radius * radius, facing));
}

}  // namespace detail

// True, with the best rival in `out`: highest priority region, then nearest to being accepted.
inline bool find_rival(const Model& m, const Query& q, const Candidate& chosen,
                       const WrenchCovariance& noise, const RivalSearch& how, Candidate& out) {
    if (!prunable(q)) return false;
    const double scale = 1.0 / m.frame.scale;
    const double turn = how.sigmas * noise.force_bound() / q.force;
    // Beyond half a radian the noise says nothing about where the axis is; the covariance says that.
    if (!(turn < 0.5)) return false;
    // How far z sigma moves the axis, and the pitch, at the far end of the probe.
    const double shift = std::hypot(how.sigmas * noise.torque_bound() / q.force, turn * m.reach) * scale;
    NodeQuery wide = make_node_query(q, how.cos_friction, push_sign(q));
    wide.reach = float(shift);
    wide.turn = float(turn);
    const double tan_friction = std::sqrt(1.0 - how.cos_friction * how.cos_friction) / how.cos_friction;
    // The axis' offset and its pitch vary independently: their z sigma add as squares.
    wide.capsule = float(std::fabs(q.h) * tan_friction + shift * (std::hypot(1.0, tan_friction) - 1.0));
    wide.free = std::fabs(q.h) <= shift ? free_direction : 0.0f;
    const Vec3 centre = scale * (chosen.point - m.frame.centre);
    const float point[3] = {float(centre.x), float(centre.y), float(centre.z)};
    const float radius = float(how.clearance * scale);
    bool found = false;
    double best = 0.0;
    const auto consider = [&](std::size_t slot) {
        Candidate c;
        double miss = 0.0;
        if (m.tree.face[slot] < 0 || !detail::nearly_accepts(m, slot, q, noise, how.sigmas, c, miss) ||
            c.cosine < how.cos_friction || norm(c.point - chosen.point) <= how.clearance)
            return;
        const bool higher = region_rank(c) < region_rank(out), same = region_rank(c) == region_rank(out);
        if (found && !higher && !(same && (miss < best || (miss == best && c.face < out.face)))) return;
        found = true;
        best = miss;
        out = c;
        out.why = Why::noise;
    };
    NodeStack stack;
    stack.item[stack.size++] = 0;
    descend(
        m.tree.nodes.data(), stack,
        [&](const Node& n) { return node_mask(n, wide) & detail::rival_mask(n, wide, point, radius); },
        [&](std::int32_t leaf) {
            const Leaf& place = m.tree.leaves[std::size_t(leaf)];
            unsigned mask = detail::rival_sieve(place, wide, point, radius) & detail::facet_sieve(place, wide);
            for (; mask != 0; mask &= mask - 1)
                consider(std::size_t(leaf) * lanes + std::size_t(std::countr_zero(mask)));
        });
    return found;
}

}  // namespace contactbench
