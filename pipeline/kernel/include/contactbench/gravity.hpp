// What a sensor reads of the tool itself: weight and bias.
//
// Contract: S frame unless a name says W; N, N*m, m. R_WS turns S into W (v_W = R_WS v_S), row major.
#pragma once

#include "vec.hpp"

namespace contactbench {

inline constexpr double standard_gravity = 9.80665;  // m/s^2

// A still sensor reads F = R_SW g + F0, M = L x (R_SW g) + M0.
struct GravityLoad {
    Vec3 gravity_W, force_bias, centre_of_mass_S, torque_bias;  // N, N, m, N*m
};

inline Vec3 to_sensor(const double R_WS[9], Vec3 v) {
    return {v.x * R_WS[0] + v.y * R_WS[3] + v.z * R_WS[6], v.x * R_WS[1] + v.y * R_WS[4] + v.z * R_WS[7],
            v.x * R_WS[2] + v.y * R_WS[5] + v.z * R_WS[8]};
}

// What the tissue does to the probe: the reading without bias and weight. `gravity_W`: the weight, or, of a tool that is
// accelerated, its weight less mass times acceleration.
inline Wrench compensate(const GravityLoad& load, Vec3 gravity_W, const double wrench[6], const double R_WS[9]) {
    const Vec3 weight_S = to_sensor(R_WS, gravity_W);
    const Vec3 F{wrench[0], wrench[1], wrench[2]}, M{wrench[3], wrench[4], wrench[5]};
    return {F - (weight_S + load.force_bias), M - (cross(load.centre_of_mass_S, weight_S) + load.torque_bias)};
}

}  // namespace contactbench
