// Could noise have hidden the true contact? Near the rim of a non-convex probe the measured axis can
// miss the touched face by a hair and go on to hit another part tens of millimetres away, alone and
// plausible. So: is there a facet, far from the chosen point, that would accept the wrench if it were
// off by no more than z sigma, and by no much larger local torque than the chosen one?
//
// Contract: S frame, SI. A rival is accepted edge by edge within z sigma of that edge's moment, and its
// contact misses the axis by no more than z sigma at the far end of the probe. Whether there is
// one does not depend on the order of facets or the frame; which of several is named may. Cost: the nodes
// that the widened axis meets away from the chosen point; on a convex probe there is no need to ask.
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

struct RivalQuery {
    NodeQuery wide;
    float point[3];    // the chosen point, normalised
    float radius = 0;  // the clearance
    float rank = 0;    // only subtrees with a region of rank at most this
};

// Bit l is set when part of child l lies further than the clearance from the point, and part of it within
// the capsule (node_mask takes that by component, which is loose where the capsule is wide).
CONTACTBENCH_INLINE unsigned rival_mask(const Node& n, const RivalQuery& r) {
    const NodeQuery& q = r.wide;
    const Float8 cx = load8(n.cx), cy = load8(n.cy), cz = load8(n.cz);
    const Float8 dx = magnitude(cx - r.point[0]) + load8(n.ex), dy = magnitude(cy - r.point[1]) + load8(n.ey),
                 dz = magnitude(cz - r.point[2]) + load8(n.ez);
    const Float8 beyond = (dx * dx + dy * dy + dz * dz) - r.radius * r.radius;
    const Float8 vx = q.mx + (cy * q.fz - cz * q.fy);
    const Float8 vy = q.my + (cz * q.fx - cx * q.fz);
    const Float8 vz = q.mz + (cx * q.fy - cy * q.fx);
    const Float8 wide = load8(n.radius) + (q.capsule + q.reach + q.margin);
    const Float8 near = wide * wide - (vx * vx + vy * vy + vz * vz);
    return nonnegative(smaller(smaller(beyond, near), r.rank - load8(n.rank)));
}

// Facets of the leaf with a corner beyond the clearance and facing the force.
CONTACTBENCH_INLINE unsigned rival_sieve(const Leaf& leaf, const RivalQuery& r) {
    const NodeQuery& q = r.wide;
    Float8 p[3][3], farthest{};
    for (int c = 0; c < 3; ++c) {
        for (int i = 0; i < 3; ++i) p[c][i] = load8(leaf.corner[c][i]);
        const Float8 dx = p[c][0] - r.point[0], dy = p[c][1] - r.point[1], dz = p[c][2] - r.point[2];
        farthest = larger(farthest, dx * dx + dy * dy + dz * dz);
    }
    const Float8 ax = p[1][0] - p[0][0], ay = p[1][1] - p[0][1], az = p[1][2] - p[0][2];
    const Float8 bx = p[2][0] - p[0][0], by = p[2][1] - p[0][1], bz = p[2][2] - p[0][2];
    const Float8 nx = ay * bz - az * by, ny = az * bx - ax * bz, nz = ax * by - ay * bx;
    const Float8 push = nx * q.nx + ny * q.ny + nz * q.nz;
    const Float8 facing = push * magnitude(push) - (0.98f * q.cos_t * q.cos_t) * (nx * nx + ny * ny + nz * nz);
    return nonnegative(smaller(farthest - r.radius * r.radius, facing));
}

// How far z sigma moves the axis at the far end of the probe, over the mesh scale.
inline double rival_shift(const Model& m, const WrenchCovariance& noise, double sigmas, double force) {
    return sigmas * noise.moment_bound(m.reach) / (force * m.frame.scale);
}

// By how much, as a normalised length, the contact that c would be misses the axis: zero for a solution.
inline double axis_miss(const Model& m, const Query& q, const Candidate& c) {
    const Vec3 p = (1.0 / m.frame.scale) * (c.point - m.frame.centre);
    const Vec3 offset = -push_sign(q) * (q.m - q.h * q.f - cross(p, q.f));
    return norm(offset - (std::fabs(q.h) / c.cosine) * (c.normal + c.cosine * q.f));
}

// A search for the best rival: highest priority region, then nearest to being accepted.
class RivalFinder {
public:
    RivalFinder(const Model& m, const Query& q, const Candidate& chosen, const WrenchCovariance& noise,
                const RivalSearch& how, Candidate& out)
        : m_(m), q_(q), chosen_(chosen), noise_(noise), how_(how), out_(out) {
        const double scale = 1.0 / m.frame.scale;
        shift_ = rival_shift(m, noise, how.sigmas, q.force);
        NodeQuery& wide = r_.wide;
        wide = make_node_query(q, how.cos_friction);
        wide.reach = float(shift_);
        const Vec3 centre = scale * (chosen.point - m.frame.centre);
        r_.point[0] = float(centre.x), r_.point[1] = float(centre.y), r_.point[2] = float(centre.z);
        r_.radius = float(how.clearance * scale);
        r_.rank = float(region_rank(chosen));  // what the chosen one outranks is no rival
    }

    bool run() {
        std::int32_t stack[lanes * 12];
        int size = 0;
        for (stack[size++] = 0; size > 0 && !settled();) {
            const Node& node = m_.tree.nodes[std::size_t(stack[--size])];
            for (unsigned mask = node_mask(node, r_.wide) & rival_mask(node, r_); mask != 0; mask &= mask - 1) {
                const int l = std::countr_zero(mask);
                const std::int32_t child = node.child[l];
                if (child == empty_child) continue;
                if (child < 0)
                    judge_facets(std::size_t(~child));
                else
                    stack[size++] = child;
            }
        }
        return found_;
    }

private:
    // A rival that outranks the chosen contact may take its place, and then it has to be the best one. Any
    // other has done its work by being there.
    bool settled() const { return found_ && region_rank(out_) >= region_rank(chosen_); }

    void judge_facets(std::size_t leaf) {
        const Leaf& place = m_.tree.leaves[leaf];
        unsigned mask = rival_sieve(place, r_) & facet_sieve(place, r_.wide);
        for (; mask != 0; mask &= mask - 1) {
            const std::size_t slot = leaf * lanes + std::size_t(std::countr_zero(mask));
            Candidate c;
            double miss = 0.0;
            if (m_.tree.face[slot] >= 0 && nearly_accepts(m_, slot, q_, noise_, how_.sigmas, c, miss)) offer(c, miss);
        }
    }

    void offer(const Candidate& c, double miss) {
        if (c.cosine < how_.cos_friction || norm(c.point - chosen_.point) <= how_.clearance) return;
        // Besides edge by edge, near as a whole: what the nodes were tested for, so that it does not depend
        // on how facets are shared out among nodes (guarded by test_the_order_of_facets_does_not_matter).
        if (axis_miss(m_, q_, c) > shift_) return;
        const std::int32_t rank = region_rank(c), best = region_rank(out_);
        if (found_ && !(rank < best || (rank == best && (miss < miss_ || (miss == miss_ && c.face < out_.face)))))
            return;
        found_ = true;
        miss_ = miss;
        out_ = c;
        out_.why = Why::noise;
        r_.rank = float(rank);
    }

    const Model& m_;
    const Query& q_;
    const Candidate& chosen_;
    const WrenchCovariance& noise_;
    const RivalSearch& how_;
    Candidate& out_;
    RivalQuery r_;
    double shift_ = 0.0, miss_ = 0.0;
    bool found_ = false;
};

}  // namespace detail

// When z sigma turn the force by more than half a radian, or the axis is too far away to prune, rivals
// cannot be told from the rest: then nothing is sure.
inline bool rivals_known(const Query& q, const WrenchCovariance& noise, double sigmas) {
    return prunable(q) && sigmas * noise.force_bound() < 0.5 * q.force;
}

// True, with the best rival in `out`. Precondition: rivals_known.
inline bool find_rival(const Model& m, const Query& q, const Candidate& chosen,
                       const WrenchCovariance& noise, const RivalSearch& how, Candidate& out) {
    return detail::RivalFinder(m, q, chosen, noise, how, out).run();
}

}  // namespace contactbench
