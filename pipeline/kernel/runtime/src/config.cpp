#include "config.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "fields.hpp"
#include "physics.hpp"

namespace contactbench::runtime {

namespace {

Vec3 three(const std::vector<double>& v, std::size_t i = 0) { return {v[i], v[i + 1], v[i + 2]}; }

// Returns the version.
std::int64_t read_kind(const Json& root) {
    const Json* schema = root.find("schema");
    const Json* version = root.find("version");
    if (!schema || schema->type != Json::Type::text || schema->text != "contactbench.runtime")
        fail(CB_ERROR_SCHEMA, "schema", "this is no runtime config of contactbench");
    if (!version || version->type != Json::Type::integer) fail(CB_ERROR_SCHEMA, "version", "not a whole number");
    if (version->integer < 1 || version->integer > CB_BUNDLE_VERSION)
        fail(CB_ERROR_VERSION, "version",
             std::to_string(version->integer) + ", and this library reads 1 to " + std::to_string(CB_BUNDLE_VERSION) +
                 ": update the older of the two");
    return version->integer;
}

void read_units(const Json& json) {
    const Fields f(json, "units", {"force", "torque", "length", "time", "angle"});
    f.literal("force", "N"), f.literal("torque", "N*m"), f.literal("length", "m");
    f.literal("time", "s"), f.literal("angle", "rad");
}

void read_frames(const Json& json, Config& c) {
    const Fields f(json, "frames", {"sensor", "world", "rotation", "wrench", "quaternion_ES"});
    f.literal("sensor", "S"), f.literal("world", "W");
    f.literal("rotation", "R_WS: v_W = R_WS v_S");
    f.literal("wrench", "what the tissue does to the probe, about the origin of S");
    if (f.is_null("quaternion_ES")) return;
    const auto q = f.numbers("quaternion_ES", 4);
    const double size = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (!(std::fabs(size - 1.0) <= 1e-9)) fail(CB_ERROR_VALUE, f.path("quaternion_ES"), "its length is not 1");
    const double w = q[0] / size, x = q[1] / size, y = q[2] / size, z = q[3] / size;
    c.R_ES = {1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),
              2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
              2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y)};
    c.settings.has_mount = true;
    std::copy(c.R_ES->begin(), c.R_ES->end(), c.settings.R_ES);
}

void read_world(const Json& json, Config& c) {
    const Fields f(json, "world", {"down_W"});
    c.down_W = three(f.numbers("down_W", 3));
    if (!(std::fabs(norm(c.down_W) - 1.0) <= 1e-9)) fail(CB_ERROR_VALUE, f.path("down_W"), "its length is not 1");
}

void read_sensor(const Json& json, Config& c) {
    const Fields f(json, "sensor", {"model", "serial", "rate_Hz"});
    c.sensor_model = f.text("model"), c.sensor_serial = f.text("serial");
    c.rate = f.number("rate_Hz", positive);
}

std::vector<double> read_gravity(const Json& json, Config& c) {
    const Fields f(json, "gravity",
                   {"gravity_W_N", "force_bias_N", "centre_of_mass_S_m", "torque_bias_Nm", "covariance"});
    c.settings.gravity = {three(f.numbers("gravity_W_N", 3)), three(f.numbers("force_bias_N", 3)),
                          three(f.numbers("centre_of_mass_S_m", 3)), three(f.numbers("torque_bias_Nm", 3))};
    auto covariance = f.matrix("covariance", 12, 12);
    check_covariance("gravity.covariance", covariance, 12);
    check_gravity(c.settings.gravity, covariance, c.down_W, c.version);
    std::copy(covariance.begin(), covariance.end(), &c.settings.zero.covariance[0][0]);
    return covariance;
}

bool is_time(std::string_view text) {
    constexpr std::string_view shape = "0000-00-00T00:00:00Z";
    if (text.size() != shape.size()) return false;
    for (std::size_t i = 0; i < shape.size(); ++i)
        if (shape[i] == '0' ? text[i] < '0' || text[i] > '9' : text[i] != shape[i]) return false;
    return true;
}

void read_time(const Fields& f, const char* name) {
    if (!is_time(f.text(name))) fail(CB_ERROR_VALUE, f.path(name), "not like 2026-01-02T03:04:05Z");
}

// Nothing here changes an answer: it is for people.
void read_zero(const Json& json) {
    const Fields f(json, "zero", {"measured", "drift"});
    if (!f.is_null("measured")) read_time(f, "measured");
    if (f.is_null("drift")) return;
    const Fields drift(f.at("drift"), "zero.drift",
                       {"force_Nps", "torque_Nmps", "force_sigma_Nps", "torque_sigma_Nmps"});
    for (const char* name : {"force_Nps", "torque_Nmps"}) drift.numbers(name, 3);
    for (const char* name : {"force_sigma_Nps", "torque_sigma_Nmps"}) drift.numbers(name, 3, not_negative);
}

void read_wrench_filter(const Json& json, Config& c) {
    if (json.type == Json::Type::null) return;
    const Fields f(json, "filters.wrench", {"kind", "rate_Hz", "q", "r", "tuned_rate_Hz", "per_sample"});
    f.literal("kind", "kalman");
    c.settings.filter_wrench = true;
    c.settings.kalman = {f.number("rate_Hz", positive), f.number("q", positive), f.number("r", positive),
                         f.number("tuned_rate_Hz", positive), f.flag("per_sample")};
}

void read_low_pass(const Json& json, Config& c) {
    if (json.type == Json::Type::null) return;
    const Fields f(json, "filters.location", {"kind", "rate_Hz", "cutoff_Hz", "order", "sections"});
    f.literal("kind", "lowpass");
    const double rate = f.number("rate_Hz", positive), cutoff = f.number("cutoff_Hz", positive);
    const std::int64_t order = f.integer("order", 1, 8);
    const std::size_t count = f.array("sections", 1, 4).size();
    const auto v = f.matrix("sections", count, 6);
    for (std::size_t i = 0; i < v.size(); i += 6)
        c.settings.sections.push_back({{v[i], v[i + 1], v[i + 2]}, {v[i + 3], v[i + 4], v[i + 5]}});
    check_low_pass(c.settings.sections, rate, cutoff, int(order));
}

void read_noise(const Json& json, Config& c, const std::vector<double>& calibration) {
    const Fields f(json, "noise", {"force_N", "torque_Nm", "orientation_rad", "wrench_covariance"});
    // Poses of a moving robot are no better than what is there, whatever the still ones of a calibration were.
    double& orientation = c.settings.zero.orientation;
    if (!f.is_null("orientation_rad")) orientation = std::max(orientation, f.number("orientation_rad", {0.0, 0.5}));
    const auto force = f.numbers("force_N", 3, not_negative), torque = f.numbers("torque_Nm", 3, not_negative);
    const auto s = f.matrix("wrench_covariance", 6, 6);
    check_covariance("noise.wrench_covariance", s, 6);
    std::copy(s.begin(), s.end(), &c.settings.noise.s[0][0]);
    check_noise(force, torque, c.settings, calibration);
}

// After the noise was checked: its model error comes on top.
void read_touch(const Json& json, Config& c) {
    const Fields f(json, "touch", {"torsion_arm_m", "model_error", "mesh_deviation_m", "mesh_curved"});
    c.settings.torsion_arm = f.number("torsion_arm_m", {0.0, 0.1});
    c.mesh = {f.number("mesh_deviation_m", {0.0, 0.1}), f.flag("mesh_curved")};
    const Fields error(f.at("model_error"), "touch.model_error", {"force_N", "torque_Nm", "measured"});
    error.flag("measured");
    auto sigma = error.numbers("force_N", 3, {0.0, 100.0});
    const auto torque = error.numbers("torque_Nm", 3, {0.0, 10.0});
    sigma.insert(sigma.end(), torque.begin(), torque.end());
    for (std::size_t i = 0; i < 6; ++i)
        for (std::size_t j = 0; j < 6; ++j) c.settings.noise.s[i][j] += i == j ? sigma[i] * sigma[i] : 0.0;
}

void read_streams(const Json& json, RuntimeSettings& s) {
    const Fields f(json, "streams", {"pose_gap_s", "pose_ahead_s", "silence_s", "frozen_probability", "motion"});
    s.poses = {f.number("pose_gap_s", {0.0, 10.0, true}), f.number("pose_ahead_s", {0.0, 10.0})};
    s.silence = f.number("silence_s", {0.0, 10.0, true});
    s.frozen_chance = f.number("frozen_probability", {1e-30, 1e-3});
    if (f.is_null("motion")) return;
    const Fields motion(f.at("motion"), "streams.motion", {"window_s", "gyration_m"});
    s.motion = {true, motion.number("window_s", {0.02, 2.0}), motion.number("gyration_m", {0.0, 1.0})};
}

void read_self_test(const Json& json, Config& c) {
    if (json.type == Json::Type::null) return;
    const Fields f(json, "self_test", {"file", "samples"});
    c.self_test = f.file("file");
    c.self_test_samples = std::size_t(f.integer("samples", 1, 100000));
}

// What so many to one are worth in d2; by the same function as the Python runtime, to the last bit.
double cost_of(double odds) { return 2.0 * std::log(odds); }

void read_gates(const Json& json, Gates& g) {
    const Fields f(json, "gates",
                   {"min_force_N", "friction_angle_rad", "ambiguity_distance_m", "implausible_misfit", "rival_odds",
                    "first_odds", "follow_odds", "follow_distance_m", "recent_samples", "max_age_s", "saturation",
                    "region_only", "accept_by_region"});
    constexpr Range odds{1.0, 1e9};
    g.min_force = f.number("min_force_N", not_negative);
    const double angle = f.number("friction_angle_rad", {0.0, 1.5708, true});
    // By way of degrees, in whole 90 of them: as the Python runtime does, to the last bit.
    const double degrees = angle * (180.0 / M_PI);
    if (!(degrees < 90.0)) fail(CB_ERROR_VALUE, f.path("friction_angle_rad"), "not below a right angle");
    g.cos_friction = std::cos(degrees * (M_PI / 180.0));
    g.ambiguity_distance = f.number("ambiguity_distance_m", not_negative);
    g.implausible_misfit = f.number("implausible_misfit", {0.45, 37.4});
    g.rival_cost = cost_of(f.number("rival_odds", odds));
    g.behind_cost = cost_of(f.number("first_odds", odds));
    g.follow_cost = cost_of(f.number("follow_odds", odds));
    g.follow_distance = f.number("follow_distance_m", not_negative);
    g.recent_samples = f.integer("recent_samples", 0, 2147483647);
    g.max_age = f.number("max_age_s", not_negative);
    const auto limits = f.limits("saturation", 6, HUGE_VAL);
    std::copy(limits.begin(), limits.end(), g.saturation);
    g.region_only = f.flag("region_only");
    g.accept_by_region = f.flag("accept_by_region");
}

void read_probe_part(const Json& json, Config& c) {
    const Fields f(json, "probe", {"file", "name", "facets", "vertices", "bounds_S_m"});
    c.probe_file = f.file("file");
    if (c.probe_file != "probe.ply") fail(CB_ERROR_VALUE, f.path("file"), "not 'probe.ply'");
    c.probe_name = f.text("name");
    c.facets = std::size_t(f.integer("facets", 4, 2'000'000));
    c.vertices = std::size_t(f.integer("vertices", 4, 2'000'000));
    const auto bounds = f.matrix("bounds_S_m", 2, 3);
    c.low = three(bounds), c.high = three(bounds, 3);
}

void read_regions(const std::vector<Json>& rows, Config& c) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const Fields f(rows[i], "regions[" + std::to_string(i) + "]",
                       {"rank", "name", "colour", "facets", "odds", "untouchable"});
        const double odds = f.number("odds", {1e-9, 1e9});
        const bool untouchable = f.flag("untouchable");
        c.regions.push_back(
            {f.integer("rank", 1, 1000), f.integer("facets", 0, 2147483647), cost_of(odds), untouchable});
        if (untouchable ? odds > 1.0 : odds < 1.0) fail(CB_ERROR_VALUE, f.path("odds"), "its untouchable denies it");
        if (c.regions.back().rank != std::int64_t(i) + 1) fail(CB_ERROR_VALUE, f.path("rank"), "not 1, 2 and so on");
        f.text("name");
        const std::string colour = f.text("colour");
        if (colour.size() != 7 || colour[0] != '#' ||
            colour.find_first_not_of("0123456789abcdef", 1) != std::string::npos)
            fail(CB_ERROR_VALUE, f.path("colour"), "not like #1f77b4");
    }
}

void read_planes(const Json& json, Config& c) {
    const Fields f(json, "planes", {"file", "count"});
    if (f.file("file") != "planes.csv") fail(CB_ERROR_VALUE, f.path("file"), "not 'planes.csv'");
    c.planes = std::size_t(f.integer("count", 0, 2147483647));
}

template <std::size_t N>
std::array<double, N> several(const Fields& f, std::string_view name, Range range = positive) {
    const auto values = f.numbers(name, N, range);
    std::array<double, N> out{};
    std::copy(values.begin(), values.end(), out.begin());
    return out;
}

// Version 1 had one gain for both turns, and left the rest to who read it: the defaults of Controller.
Controller read_old_controller(const Json& json) {
    const Fields f(json, "controller",
                   {"desired_force_N", "force_mass_kg", "force_damping_Nspm", "force_stiffness_Npm",
                    "angle_inertia", "angle_damping", "angle_stiffness"});
    Controller c;
    c.desired_force = f.number("desired_force_N", positive);
    c.force_mass = f.number("force_mass_kg", positive), c.force_damping = f.number("force_damping_Nspm", positive);
    c.force_stiffness = f.number("force_stiffness_Npm", not_negative);
    c.angle_inertia.fill(f.number("angle_inertia", positive));
    c.angle_damping.fill(f.number("angle_damping", positive));
    c.angle_stiffness.fill(f.number("angle_stiffness", not_negative));
    return c;
}

void read_gains(const Fields& controller, Controller& c) {
    const Fields force(controller.at("force"), "controller.force",
                       {"mass_kg", "damping_Nspm", "stiffness_Npm", "gain_per_s"});
    c.force_mass = force.number("mass_kg", positive), c.force_damping = force.number("damping_Nspm", positive);
    c.force_stiffness = force.number("stiffness_Npm", not_negative);
    c.force_gain = force.number("gain_per_s", positive);
    const Fields angle(controller.at("angle"), "controller.angle",
                       {"inertia", "damping", "stiffness", "gain_per_s", "settling_s"});
    c.angle_inertia = several<2>(angle, "inertia"), c.angle_damping = several<2>(angle, "damping");
    c.angle_stiffness = several<2>(angle, "stiffness", not_negative);
    c.angle_gain = several<2>(angle, "gain_per_s"), c.settling = angle.number("settling_s", positive);
    const Fields lead(controller.at("lead"), "controller.lead",
                      {"bandwidth_per_s", "smoothing_s", "lean_rad", "lean_s"});
    c.bandwidth = several<3>(lead, "bandwidth_per_s"), c.smoothing = lead.number("smoothing_s", positive);
    c.lean_angle = lead.number("lean_rad", positive), c.lean_time = lead.number("lean_s", positive);
}

void read_behaviour(const Fields& controller, Controller& c) {
    const Fields touch(controller.at("touch"), "controller.touch",
                       {"approach_speed_mps", "approach_travel_m", "retract_speed_mps", "retract_travel_m",
                        "touch_force_N", "low_force_N", "ramp_s", "probing_m", "attempts"});
    c.approach_speed = touch.number("approach_speed_mps", positive);
    c.approach_travel = touch.number("approach_travel_m", positive);
    c.retract_speed = touch.number("retract_speed_mps", positive);
    c.retract_travel = touch.number("retract_travel_m", positive);
    c.touch_force = touch.number("touch_force_N", positive), c.low_force = touch.number("low_force_N", positive);
    c.ramp = touch.number("ramp_s", positive), c.probing = touch.number("probing_m", not_negative);
    c.attempts = touch.integer("attempts", 0, 2147483647);
    const Fields tool(controller.at("tool"), "controller.tool",
                      {"left_force_N", "left_torque_Nm", "taring_s", "gyration_m"});
    c.left_force = tool.number("left_force_N", positive), c.left_torque = tool.number("left_torque_Nm", positive);
    c.taring = tool.number("taring_s", not_negative), c.gyration = tool.number("gyration_m", not_negative);
    const Fields watch(controller.at("watch"), "controller.watch",
                       {"stale_s", "give_up_s", "following_s", "max_tilt_rad"});
    c.stale = watch.number("stale_s", positive), c.give_up = watch.number("give_up_s", positive);
    c.following = watch.number("following_s", positive);
    c.max_tilt = watch.number("max_tilt_rad", {0.0, 1.5708, true});
    if (!(c.max_tilt < 1.5708)) fail(CB_ERROR_VALUE, watch.path("max_tilt_rad"), "not below a right angle");
}

Controller read_new_controller(const Json& json) {
    const Fields f(json, "controller",
                   {"variant", "desired_force_N", "period_s", "servo_lag_s", "force", "angle", "lead", "touch",
                    "tool", "watch"});
    Controller c;
    const std::string variant = f.text("variant");
    c.aware = variant == "aware";
    if (!c.aware && variant != "plain") fail(CB_ERROR_SCHEMA, f.path("variant"), "neither 'plain' nor 'aware'");
    c.desired_force = f.number("desired_force_N", positive);
    c.period = f.number("period_s", positive), c.servo_lag = f.number("servo_lag_s", not_negative);
    read_gains(f, c);
    read_behaviour(f, c);
    return c;
}

void read_controller(const Json& json, std::int64_t version, Config& c) {
    if (json.type == Json::Type::null) return;
    c.controller = version == 1 ? read_old_controller(json) : read_new_controller(json);
}

void read_limits(const Json& json, Config& c) {
    const Fields f(json, "limits", {"max_force_N", "max_torque_Nm", "max_speed_mps", "max_turn_radps"});
    c.max_force = f.number("max_force_N", positive), c.max_torque = f.number("max_torque_Nm", positive);
    if (!f.is_null("max_speed_mps")) c.max_speed = f.number("max_speed_mps", positive);
    if (!f.is_null("max_turn_radps")) c.max_turn = f.number("max_turn_radps", positive);
    if (c.controller && !(c.controller->desired_force < c.max_force))
        fail(CB_ERROR_VALUE, "controller.desired_force_N", "not below limits.max_force_N");
}

// Returns whether it passed.
bool read_verification(const Json& json) {
    if (json.type == Json::Type::null) return false;
    const Fields f(json, "verification",
                   {"touches", "markers", "mean_error_m", "sd_error_m", "p95_error_m", "max_error_m", "ratio",
                    "p99_time_s", "limit_mean_m", "limit_max_m", "passed", "diagnosis"});
    for (const char* name : {"touches", "markers"}) f.integer(name, 0, 2147483647);
    for (const char* name : {"mean_error_m", "sd_error_m", "p95_error_m", "max_error_m"}) f.number(name, not_negative);
    for (const char* name : {"ratio", "p99_time_s"})
        if (!f.is_null(name)) f.number(name, not_negative);
    for (const char* name : {"limit_mean_m", "limit_max_m"}) f.number(name, positive);
    f.text("diagnosis", 10'000);
    const bool within = f.number("mean_error_m") <= f.number("limit_mean_m") &&
                        f.number("max_error_m") <= f.number("limit_max_m");
    const bool passed = f.flag("passed");
    return passed && within;
}

// Returns whether it did not fail.
bool read_check(const Fields& f) {
    const std::string outcome = f.text("outcome");
    if (outcome != "passed" && outcome != "failed" && outcome != "undecided")
        fail(CB_ERROR_SCHEMA, f.path("outcome"), "neither 'passed', 'failed' nor 'undecided'");
    if (!f.is_null("created")) read_time(f, "created");
    return outcome != "failed";
}

bool read_known_weight(const Json& json) {
    if (json.type == Json::Type::null) return true;
    const Fields f(json, "checks.known_weight",
                   {"mass_kg", "mass_sigma_kg", "certificate", "measured_kg", "measured_sigma_kg", "outcome",
                    "created"});
    f.number("mass_kg", positive), f.number("measured_kg");
    f.number("mass_sigma_kg", not_negative), f.number("measured_sigma_kg", not_negative);
    if (!f.is_null("certificate")) f.text("certificate");
    return read_check(f);
}

bool read_known_touch(const Json& json) {
    if (json.type == Json::Type::null) return true;
    const Fields f(json, "checks.known_touch",
                   {"point_S_m", "located_S_m", "error_m", "sigma_m", "outcome", "created"});
    f.numbers("point_S_m", 3);
    if (!f.is_null("located_S_m")) f.numbers("located_S_m", 3);
    for (const char* name : {"error_m", "sigma_m"})
        if (!f.is_null(name)) f.number(name, not_negative);
    if (f.text("outcome") == "passed" && (f.is_null("located_S_m") || f.is_null("error_m")))
        fail(CB_ERROR_VALUE, f.path("outcome"), "'passed', but nothing was located");
    return read_check(f);
}

// Returns whether none failed.
bool read_checks(const Json& json) {
    const Fields f(json, "checks", {"known_weight", "known_touch"});
    const bool weight = read_known_weight(f.at("known_weight")), touch = read_known_touch(f.at("known_touch"));
    return weight && touch;
}

// Returns whether nothing was stale.
bool read_provenance(const Json& json, Config& c) {
    const Fields f(json, "provenance",
                   {"created", "tool", "operator", "session", "files", "sources", "stale"});
    read_time(f, "created");
    f.text("tool"), f.text("operator");
    if (!f.is_null("session")) f.text("session");
    const Json& files = f.at("files");
    if (files.type != Json::Type::object || files.members.empty() || files.members.size() > 50)
        fail(CB_ERROR_SCHEMA, f.path("files"), "not an object of 1 to 50 files");
    for (const auto& [name, hash] : files.members) {
        if (!is_file_name(name)) fail(CB_ERROR_VALUE, f.path("files"), "holds a name that is no file of a bundle");
        if (hash.type != Json::Type::text || !is_hash(hash.text))
            fail(CB_ERROR_VALUE, f.path("files") + "." + name, "not a SHA-256");
        c.files.emplace_back(name, hash.text);
    }
    const auto& sources = f.array("sources", 0, 200);
    for (std::size_t i = 0; i < sources.size(); ++i) {
        const Fields s(sources[i], "provenance.sources[" + std::to_string(i) + "]", {"role", "name", "sha256"});
        s.text("role"), s.text("name"), s.hash("sha256");
    }
    for (const Json& item : f.array("stale", 0, 100)) to_text(item, f.path("stale"), 1000);
    return f.array("stale", 0, 100).empty();
}

// What version 2 left open: as contactbench.pipeline.config.runtime.migrate has it.
constexpr std::string_view touch_of_old =
    R"({"torsion_arm_m":0.001,"model_error":{"force_N":[0.05,0.05,0.05],"torque_Nm":[0.001,0.001,0.001],)"
    R"("measured":false},"mesh_deviation_m":0.0,"mesh_curved":true})";
constexpr std::string_view streams_of_old =
    R"({"pose_gap_s":0.25,"pose_ahead_s":0.15,"silence_s":0.12,"frozen_probability":1e-10,"motion":null})";
constexpr std::string_view gates_of_old =
    R"({"implausible_misfit":10.827566170662935,"rival_odds":100.0,"first_odds":7.38905609893065,)"
    R"("follow_odds":1000.0,"accept_by_region":true})";
constexpr std::string_view region_of_old[] = {R"({"odds":1000.0,"untouchable":false})",
                                              R"({"odds":100.0,"untouchable":false})",
                                              R"({"odds":10.0,"untouchable":false})"};  // the last for all that follow

void add(Json& object, std::string_view members) {
    for (auto& member : parse_json(members).members) object.members.push_back(std::move(member));
}

// From version 2 to 3; Fields sees to it that nothing of version 3 was there. It ranked touches by rules.
void from_2(Json& root) {
    Fields(root, "",
           {"schema", "version", "units", "frames", "sensor", "gravity", "noise", "filters", "gates", "probe",
            "regions", "planes", "controller", "limits", "verification", "verified", "provenance"})
        .array("regions", 0, 1000);
    for (auto& [name, value] : root.members) {
        if (name == "gates") {
            const Fields f(value, "gates",
                           {"min_force_N", "friction_angle_rad", "ambiguity_distance_m", "torque_ratio",
                            "rival_sigmas", "follow_distance_m", "recent_samples", "max_age_s", "saturation",
                            "region_only"});
            std::erase_if(value.members,
                          [](const auto& m) { return m.first == "torque_ratio" || m.first == "rival_sigmas"; });
            add(value, gates_of_old);
        }
        if (name != "regions") continue;
        for (std::size_t i = 0; i < value.items.size(); ++i) {
            const Fields f(value.items[i], "regions[" + std::to_string(i) + "]", {"rank", "name", "colour", "facets"});
            add(value.items[i], region_of_old[std::min(i, std::size(region_of_old) - 1)]);
        }
    }
    root.members.emplace_back("touch", parse_json(touch_of_old));
    root.members.emplace_back("streams", parse_json(streams_of_old));
    root.members.emplace_back("self_test", Json{});
}

// What version 3 left open.
constexpr std::string_view parts_of_old =
    R"({"world":{"down_W":[0.0,0.0,-1.0]},"zero":{"measured":null,"drift":null},)"
    R"("checks":{"known_weight":null,"known_touch":null}})";

// From version 3 to 4; Fields sees to it that nothing of version 4 was there. It took -z of W for down.
void from_3(Json& root) {
    Fields(root, "",
           {"schema", "version", "units", "frames", "sensor", "gravity", "noise", "touch", "streams", "filters", "gates",
            "probe", "regions", "planes", "controller", "limits", "verification", "self_test", "verified",
            "provenance"});
    for (auto& [name, value] : root.members) {
        if (name == "frames") {
            Fields(value, "frames", {"sensor", "world", "rotation", "wrench", "quaternion_ES"})
                .literal("world", "W, z up");
            for (auto& [field, text] : value.members)
                if (field == "world") text.text.assign(1, 'W');
        }
        if (name != "noise") continue;
        Fields(value, "noise", {"force_N", "torque_Nm", "wrench_covariance"});
        value.members.emplace_back("orientation_rad", Json{});
    }
    add(root, parts_of_old);
}

}  // namespace

Config read_config(std::string_view text) {
    Json root = parse_json(text);
    if (root.type != Json::Type::object) fail(CB_ERROR_JSON, "the file", "not an object");
    const std::int64_t version = read_kind(root);
    if (version < 3) from_2(root);
    if (version < 4) from_3(root);
    const Fields f(root, "",
                   {"schema", "version", "units", "frames", "world", "sensor", "gravity", "zero", "noise", "touch",
                    "streams", "filters", "gates", "probe", "regions", "planes", "controller", "limits", "verification",
                    "checks", "self_test", "verified", "provenance"});
    Config c;
    c.version = version;
    read_units(f.at("units"));
    read_frames(f.at("frames"), c);
    read_world(f.at("world"), c);
    read_sensor(f.at("sensor"), c);
    const auto calibration = read_gravity(f.at("gravity"), c);
    read_zero(f.at("zero"));
    const Fields filters(f.at("filters"), "filters", {"wrench", "location"});
    read_wrench_filter(filters.at("wrench"), c);
    read_low_pass(filters.at("location"), c);
    read_noise(f.at("noise"), c, calibration);
    read_touch(f.at("touch"), c);
    read_streams(f.at("streams"), c.settings);
    read_gates(f.at("gates"), c.settings.gates);
    read_probe_part(f.at("probe"), c);
    read_regions(f.array("regions", 0, 1000), c);
    read_planes(f.at("planes"), c);
    read_controller(f.at("controller"), version, c);
    read_limits(f.at("limits"), c);
    read_self_test(f.at("self_test"), c);
    const bool passed = read_verification(f.at("verification")), sound = read_checks(f.at("checks"));
    const bool fresh = read_provenance(f.at("provenance"), c);
    c.verified = f.flag("verified");
    if (c.verified && !(passed && fresh && sound))
        fail(CB_ERROR_VALUE, "verified", "true, but the verification is missing, did not pass, or is stale, or a check failed");
    return c;
}

}  // namespace contactbench::runtime
