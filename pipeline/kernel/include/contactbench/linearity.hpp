// Does the first-order covariance describe what noise will do to this answer?
//
// Sigma points: a torque change of (n . F) (d x n) moves the point of the flat facet by exactly d. Put
// d at two standard deviations along both axes of the ellipse, either way, solve again on the real mesh
// and compare. Edges, rims, gaps, curvature and rivals all show. The force's direction enters through
// sigma_F / |n . F|, which must be small.
//
// Contract: four solves, so asked for only on request. No allocation.
#pragma once

#include "solver.hpp"

namespace contactbench {

inline constexpr double sigma_point_distance = 2.0;   // standard deviations
inline constexpr double sigma_point_tolerance = 0.1;  // of that distance
inline constexpr double steepest_linear_ratio = 0.1;   // sigma_F / |n . F|

// Half axes (one standard deviation, as vectors in the tangent plane) of a rank-2 covariance.
inline std::array<Vec3, 2> ellipse_axes(const Mat3& s, Vec3 n) {
    const Vec3 seed = std::fabs(n.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    Vec3 a = cross(n, seed);
    a = (1.0 / norm(a)) * a;
    const Vec3 b = cross(n, a);
    const auto apply = [&](Vec3 v) {
        return Vec3{s.m[0][0] * v.x + s.m[0][1] * v.y + s.m[0][2] * v.z,
                    s.m[1][0] * v.x + s.m[1][1] * v.y + s.m[1][2] * v.z,
                    s.m[2][0] * v.x + s.m[2][1] * v.y + s.m[2][2] * v.z};
    };
    const double aa = dot(a, apply(a)), ab = dot(a, apply(b)), bb = dot(b, apply(b));
    const double turn = 0.5 * std::atan2(2.0 * ab, aa - bb);
    const double mean = 0.5 * (aa + bb), half = std::hypot(0.5 * (aa - bb), ab);
    const Vec3 major = std::cos(turn) * a + std::sin(turn) * b;
    const double large = std::sqrt(std::max(0.0, mean + half)), small = std::sqrt(std::max(0.0, mean - half));
    return {large * major, small * cross(n, major)};
}

inline bool is_linear(const Solver& solver, const Wrench& w, const Candidate& c) {
    const double push = dot(c.normal, w.F);
    if (!(solver.noise().force_bound() <= steepest_linear_ratio * std::fabs(push))) return false;
    for (const Vec3& axis : ellipse_axes(contact_covariance(c, w.F, solver.noise()), c.normal))
        for (const double side : {-sigma_point_distance, sigma_point_distance}) {
            const Vec3 d = side * axis;
            const Answer a = solver.locate({w.F, w.M + push * cross(d, c.normal)}, &c.point);
            if (!accepted(a.reason)) return false;
            const Vec3 miss = a.hits[std::size_t(a.chosen)].point - (c.point + d);
            if (!(norm(miss) <= sigma_point_tolerance * norm(d))) return false;
        }
    return true;
}

}  // namespace contactbench
