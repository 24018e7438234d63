// The contact test on one facet: linear in the wrench.
//
// For a directed edge a -> b let w(a, b) = M . (b - a) + F . (a x b), the moment of the wrench about
// the edge's line. With p x F + k n = M and n . p = n . a it equals F . ((a - p) x (b - p)), twice the
// signed area that p spans with the edge times n . F. So a counter-clockwise facet holds the contact
// point of a pushing wrench exactly when w < 0 on its three edges, whatever the local torque k, and
// the three values are the barycentric coordinates of p: no division until a facet is accepted.
//
// Contract
//   units    S-frame metres, N, N*m outside; inside, lengths are divided by `Frame::scale` about
//            `Frame::centre` and the wrench by its force, so every number here is of order one for a
//            mesh of any size and place.
//   ties     w == 0 counts as negative on the half-edge that runs from the lower vertex number to the
//            higher one and as positive on its twin. Both halves carry the same constants with the
//            sign flipped, so a point on a shared edge belongs to exactly one facet, rounding or not.
//   cost     18 multiply-adds a facet; scan.hpp does them eight facets at a time.
#pragma once

#include "topology.hpp"
#include "vec.hpp"

namespace contactbench {

struct Frame {
    Vec3 centre;
    double scale = 1.0;
};

// A wrench made dimensionless: f = F/|F|, m its moment about the mesh centre over |F| and the scale.
// h = m . f is the pitch; it is the same about every point.
struct Query {
    Vec3 f, m;
    double h = 0.0;
    double force = 0.0;  // |F|, N
};

// Precondition: the wrench is finite and |F| > 0.
inline Query make_query(const Frame& frame, const Wrench& wrench) {
    Query q;
    q.force = norm(wrench.F);
    q.f = (1.0 / q.force) * wrench.F;
    q.m = (1.0 / (q.force * frame.scale)) * (wrench.M - cross(frame.centre, wrench.F));
    q.h = dot(q.m, q.f);
    return q;
}

// The three edges of one facet: b - a, then a x b, for each. Corner 0 is the facet's lowest vertex
// number, so edge 0 runs upwards, edge 2 downwards, and only edge 1 has to ask (`rises`).
struct FacetEdges {
    double edge[3][6] = {};
};

struct EdgeMoments {
    double w[3];
};

struct EdgeConstants {
    Vec3 along, moment;  // b - a and a x b, normalised units
};

// Computed once per undirected edge and negated for its twin, so that both halves agree to the bit.
inline EdgeConstants edge_constants(Vec3 a, Vec3 b, bool upwards) {
    if (!upwards) {
        const EdgeConstants c = edge_constants(b, a, true);
        return {-c.along, -c.moment};
    }
    return {b - a, cross(a, b)};
}

inline double edge_moment(const FacetEdges& facet, int edge, const Query& q) {
    const double* c = facet.edge[edge];
    return ((q.m.x * c[0] + q.m.y * c[1]) + q.m.z * c[2]) +
           ((q.f.x * c[3] + q.f.y * c[4]) + q.f.z * c[5]);
}

// Does edge 1 run from the lower vertex number to the higher?
inline bool rises(const Triangle& t) { return t[1] < t[2]; }

// Is w negative on this half-edge, by the tie rule above?
inline bool edge_negative(int edge, bool upwards, double w) {
    return edge == 0 || (edge == 1 && upwards) ? w <= 0.0 : w < 0.0;
}

// Does the facet accept the wrench?
inline bool accepts(const FacetEdges& facet, const Triangle& t, const Query& q, EdgeMoments& out) {
    for (int e = 0; e < 3; ++e) out.w[e] = edge_moment(facet, e, q);
    return out.w[0] <= 0.0 && edge_negative(1, rises(t), out.w[1]) && out.w[2] < 0.0;
}

inline FacetEdges facet_edges(const Triangle& t, const Vec3* normalised) {
    FacetEdges facet;
    for (int e = 0; e < 3; ++e) {
        const std::int32_t a = t[std::size_t(e)], b = t[std::size_t((e + 1) % 3)];
        const EdgeConstants c = edge_constants(normalised[a], normalised[b], a < b);
        const double values[6] = {c.along.x, c.along.y, c.along.z, c.moment.x, c.moment.y, c.moment.z};
        std::copy(values, values + 6, facet.edge[e]);
    }
    return facet;
}

// The facet with its lowest vertex number first, winding kept.
inline Triangle lowest_first(const Triangle& t) {
    const std::size_t i = std::size_t(std::min_element(t.begin(), t.end()) - t.begin());
    return {t[i], t[(i + 1) % 3], t[(i + 2) % 3]};
}

}  // namespace contactbench
