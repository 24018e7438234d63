// First-order uncertainty of a contact point: the smallest error that any unbiased method can reach.
//
// Differentiating p x F + k n = M on the plane n . p = const, and taking n x (...), gives
//   dp = n x (dM - p x dF) / (n . F),
// so Sigma_p = J Sigma_w J^T with J = [-G [p]x, G] and G = [n]x / (n . F).
//
// Contract: Sigma_w (6, 6) row major, force before torque, S frame, N^2, N^2*m and N^2*m^2; result in
// m^2, S frame, rank 2 (no error leaves the facet's plane). O(1), no allocation.
// Precondition: n . F != 0.
#pragma once

#include "candidate.hpp"

namespace contactbench {

struct WrenchCovariance {
    double s[6][6] = {};

    // Upper bounds of the standard deviation of any component of force (N) and torque (N*m).
    double force_bound() const { return std::sqrt(row_sum(0)); }
    double torque_bound() const { return std::sqrt(row_sum(3)); }

    // Standard deviation that bounds the moment about any point within `lever` metres, N*m.
    double moment_bound(double lever) const {
        bool correlated = false;
        for (int i = 0; i < 3; ++i)
            for (int j = 3; j < 6; ++j) correlated |= s[i][j] != 0.0;
        const double torque = torque_bound(), force = force_bound() * lever;
        return correlated ? torque + force : std::hypot(torque, force);
    }

private:
    // Largest absolute row sum of a diagonal block: no eigenvalue of it is larger.
    double row_sum(int first) const {
        double largest = 0.0;
        for (int i = first; i < first + 3; ++i) {
            double sum = 0.0;
            for (int j = first; j < first + 3; ++j) sum += std::fabs(s[i][j]);
            largest = std::max(largest, sum);
        }
        return largest;
    }
};

struct PointJacobian {
    double j[3][6] = {};  // dp / d(F, M)
};

inline PointJacobian point_jacobian(Vec3 p, Vec3 n, Vec3 F) {
    const double scale = 1.0 / dot(n, F);
    PointJacobian out;
    const Vec3 unit[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int i = 0; i < 3; ++i) {
        const Vec3 force = -scale * cross(n, cross(p, unit[i])), torque = scale * cross(n, unit[i]);
        const double columns[2][3] = {{force.x, force.y, force.z}, {torque.x, torque.y, torque.z}};
        for (int r = 0; r < 3; ++r) out.j[r][i] = columns[0][r], out.j[r][i + 3] = columns[1][r];
    }
    return out;
}

inline Mat3 point_covariance(const PointJacobian& jacobian, const WrenchCovariance& noise) {
    double js[3][6] = {};
    for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 6; ++c)
            for (int i = 0; i < 6; ++i) js[r][c] += jacobian.j[r][i] * noise.s[i][c];
    Mat3 out;
    for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c)
            for (int i = 0; i < 6; ++i) out.m[r][c] += js[r][i] * jacobian.j[c][i];
    return out;
}

inline Mat3 contact_covariance(const Candidate& c, Vec3 F, const WrenchCovariance& noise) {
    return point_covariance(point_jacobian(c.point, c.normal, F), noise);
}

}  // namespace contactbench
