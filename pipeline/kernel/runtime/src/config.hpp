// contactbench.json, checked: every field there is, of its type, in its range, and physically possible.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "contactbench/runtime.hpp"
#include "errors.hpp"

namespace contactbench::runtime {

struct RegionRow {
    std::int64_t rank, facets;
    double bonus;  // 2 ln(odds)
    bool untouchable;
};

// A controller as bundles hold it; what each number is: cb_controller.
struct Controller {
    bool aware = true;
    double desired_force = 0.0, period = 0.02, servo_lag = 0.0;
    double force_mass = 0.0, force_damping = 0.0, force_stiffness = 0.0, force_gain = 6.0;
    std::array<double, 2> angle_inertia{}, angle_damping{}, angle_stiffness{}, angle_gain{6.0, 6.0};
    double settling = 0.04;
    std::array<double, 3> bandwidth{20.0, 13.0, 13.0};
    double smoothing = 0.08, lean_angle = 0.025, lean_time = 0.8;
    double approach_speed = 0.006, approach_travel = 0.05, retract_speed = 0.06, retract_travel = 0.03;
    double touch_force = 0.7, low_force = 0.7, ramp = 0.5, probing = 0.00015;
    std::int64_t attempts = 3;
    double left_force = 0.01, left_torque = 0.0005, taring = 0.5, gyration = 0.035;
    double stale = 0.06, give_up = 0.2, following = 0.05, max_tilt = 0.5;
};

struct Config {
    RuntimeSettings settings;
    std::int64_t version = 0;  // as it was written
    bool verified = false;
    std::string sensor_model, sensor_serial, probe_name, probe_file;
    std::size_t facets = 0, vertices = 0, planes = 0;
    MeshTerms mesh;
    Vec3 low, high;  // bounds of the probe, S, m
    std::vector<RegionRow> regions;
    Vec3 down_W{0.0, 0.0, -1.0};  // a unit vector
    double rate = 0.0, max_force = 0.0, max_torque = 0.0;
    double max_speed = HUGE_VAL, max_turn = HUGE_VAL;  // tip, m/s and rad/s
    std::optional<Controller> controller;
    std::optional<std::array<double, 9>> R_ES;
    std::string self_test;  // a file; empty: none
    std::size_t self_test_samples = 0;
    std::vector<std::pair<std::string, std::string>> files;  // name, SHA-256
};

// Of this version or an older one. Throws LoadError.
Config read_config(std::string_view json);

}  // namespace contactbench::runtime
