#include "config.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "physics.hpp"
#include "schema.hpp"

namespace contactbench::runtime {

namespace {

// Of an array, row by row.
std::vector<double> numbers(const Json& array) {
    std::vector<double> out;
    for (const Json& item : array.items) {
        if (item.type != Json::Type::array) out.push_back(item.number);
        const auto below = numbers(item);
        out.insert(out.end(), below.begin(), below.end());
    }
    return out;
}

Vec3 three(const std::vector<double>& v, std::size_t i = 0) { return {v[i], v[i + 1], v[i + 2]}; }
Vec3 three(const Json& array) { return three(numbers(array)); }
bool is_null(const Json& value) { return value.type == Json::Type::null; }

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

void read_frames(const Json& frames, Config& c) {
    if (is_null(frames["quaternion_ES"])) return;
    const auto q = numbers(frames["quaternion_ES"]);
    const double size = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (!(std::fabs(size - 1.0) <= 1e-9)) fail(CB_ERROR_VALUE, "frames.quaternion_ES", "its length is not 1");
    const double w = q[0] / size, x = q[1] / size, y = q[2] / size, z = q[3] / size;
    c.R_ES = {1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),
              2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
              2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y)};
    c.settings.has_mount = true;
    std::copy(c.R_ES->begin(), c.R_ES->end(), c.settings.R_ES);
}

std::vector<double> read_gravity(const Json& gravity, Config& c) {
    c.settings.gravity = {three(gravity["gravity_W_N"]), three(gravity["force_bias_N"]),
                          three(gravity["centre_of_mass_S_m"]), three(gravity["torque_bias_Nm"])};
    auto covariance = numbers(gravity["covariance"]);
    check_covariance("gravity.covariance", covariance, 12);
    check_gravity(c.settings.gravity, covariance, c.down_W, c.version);
    std::copy(covariance.begin(), covariance.end(), &c.settings.zero.covariance[0][0]);
    return covariance;
}

// Later than version 4: where it is not there, the zero does not follow.
void read_zero(const Json& zero, RuntimeSettings& s) {
    const Json* follow = zero.find("follow");
    s.follow = follow && follow->boolean;
}

void read_filters(const Json& filters, const Json& noise, RuntimeSettings& s) {
    const Json &wrench = filters["wrench"], &location = filters["location"];
    s.filter_wrench = !is_null(wrench);
    if (s.filter_wrench) {
        s.kalman = {wrench["rate_Hz"].number, wrench["q"].number, wrench["r"].number,
                    wrench["tuned_rate_Hz"].number, wrench["per_sample"].boolean, wrench["kind"].text == "adaptive"};
        std::ranges::copy(numbers(noise["force_N"]), s.kalman.sigma);
        std::ranges::copy(numbers(noise["torque_Nm"]), s.kalman.sigma + 3);
    }
    if (is_null(location)) return;
    const auto v = numbers(location["sections"]);
    for (std::size_t i = 0; i < v.size(); i += 6)
        s.sections.push_back({{v[i], v[i + 1], v[i + 2]}, {v[i + 3], v[i + 4], v[i + 5]}});
    check_low_pass(s.sections, location["rate_Hz"].number, location["cutoff_Hz"].number,
                   int(location["order"].integer));
}

void read_noise(const Json& noise, RuntimeSettings& settings, const std::vector<double>& calibration) {
    // Poses of a moving robot are no better than what is there, whatever the still ones of a calibration were.
    settings.zero.orientation = std::max(settings.zero.orientation, noise["orientation_rad"].number);
    const auto s = numbers(noise["wrench_covariance"]);
    check_covariance("noise.wrench_covariance", s, 6);
    std::copy(s.begin(), s.end(), &settings.noise.s[0][0]);
    check_noise(numbers(noise["force_N"]), numbers(noise["torque_Nm"]), settings, calibration);
}

// After the noise was checked: its model error comes on top.
void read_touch(const Json& touch, Config& c) {
    const Json* torsion = touch.find("torsion");
    c.settings.torsion = {touch["torsion_arm_m"].number, torsion && torsion->text == "learned"};
    c.mesh = {touch["mesh_deviation_m"].number, touch["mesh_curved"].boolean};
    auto sigma = numbers(touch["model_error"]["force_N"]);
    const auto torque = numbers(touch["model_error"]["torque_Nm"]);
    sigma.insert(sigma.end(), torque.begin(), torque.end());
    for (std::size_t i = 0; i < 6; ++i)
        for (std::size_t j = 0; j < 6; ++j) c.settings.noise.s[i][j] += i == j ? sigma[i] * sigma[i] : 0.0;
}

void read_streams(const Json& streams, RuntimeSettings& s) {
    s.poses = {streams["pose_gap_s"].number, streams["pose_ahead_s"].number};
    s.silence = streams["silence_s"].number;
    s.frozen_chance = streams["frozen_probability"].number;
    const Json& motion = streams["motion"];
    if (!is_null(motion)) s.motion = {true, motion["window_s"].number, motion["gyration_m"].number};
}

// What so many to one are worth in d2; by the same function as the Python runtime, to the last bit.
double cost_of(double odds) { return 2.0 * std::log(odds); }

void read_gate(const Json& json, double& to, From from) {
    to = json.number;
    if (from == From::odds) to = cost_of(to);
    if (from != From::angle) return;
    // By way of degrees, in whole 90 of them: as the Python runtime does, to the last bit.
    const double degrees = to * (180.0 / M_PI);
    if (!(degrees < 90.0)) fail(CB_ERROR_VALUE, "gates.friction_angle_rad", "not below a right angle");
    to = std::cos(degrees * (M_PI / 180.0));
}
void read_gate(const Json& json, std::int64_t& to, From) { to = json.integer; }
void read_gate(const Json& json, bool& to, From) { to = json.boolean; }
void read_gate(const Json& json, double (&to)[6], From) {
    std::transform(json.items.begin(), json.items.end(), to,
                   [](const Json& limit) { return is_null(limit) ? HUGE_VAL : limit.number; });
}

void read_probe_part(const Json& probe, Config& c) {
    c.probe_file = probe["file"].text;
    if (c.probe_file != "probe.ply") fail(CB_ERROR_VALUE, "probe.file", "not 'probe.ply'");
    c.probe_name = probe["name"].text;
    c.facets = std::size_t(probe["facets"].integer);
    c.vertices = std::size_t(probe["vertices"].integer);
    const auto bounds = numbers(probe["bounds_S_m"]);
    c.low = three(bounds), c.high = three(bounds, 3);
}

void read_regions(const std::vector<Json>& rows, Config& c) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const std::string path = "regions[" + std::to_string(i) + "].";
        const double odds = rows[i]["odds"].number;
        const bool untouchable = rows[i]["untouchable"].boolean;
        c.regions.push_back({rows[i]["rank"].integer, rows[i]["facets"].integer, cost_of(odds), untouchable});
        if (untouchable ? odds > 1.0 : odds < 1.0) fail(CB_ERROR_VALUE, path + "odds", "its untouchable denies it");
        if (rows[i]["rank"].integer != std::int64_t(i) + 1) fail(CB_ERROR_VALUE, path + "rank", "not 1, 2 and so on");
    }
}

void read_planes(const Json& planes, Config& c) {
    if (planes["file"].text != "planes.csv") fail(CB_ERROR_VALUE, "planes.file", "not 'planes.csv'");
    c.planes = std::size_t(planes["count"].integer);
}

// One number of a controller: where it stands, and where it goes.
struct Gain {
    const char *part, *name;
    double cb_controller::*to;
};
constexpr Gain gains[] = {
    {"force", "mass_kg", &cb_controller::force_mass_kg},
    {"force", "damping_Nspm", &cb_controller::force_damping_Nspm},
    {"force", "stiffness_Npm", &cb_controller::force_stiffness_Npm},
    {"force", "gain_per_s", &cb_controller::force_gain_per_s},
    {"angle", "settling_s", &cb_controller::settling_s},
    {"lead", "smoothing_s", &cb_controller::smoothing_s},
    {"lead", "lean_rad", &cb_controller::lean_rad},
    {"lead", "lean_s", &cb_controller::lean_s},
    {"touch", "approach_speed_mps", &cb_controller::approach_speed_mps},
    {"touch", "approach_travel_m", &cb_controller::approach_travel_m},
    {"touch", "retract_speed_mps", &cb_controller::retract_speed_mps},
    {"touch", "retract_travel_m", &cb_controller::retract_travel_m},
    {"touch", "touch_force_N", &cb_controller::touch_force_N},
    {"touch", "low_force_N", &cb_controller::low_force_N},
    {"touch", "ramp_s", &cb_controller::ramp_s},
    {"touch", "probing_m", &cb_controller::probing_m},
    {"tool", "left_force_N", &cb_controller::left_force_N},
    {"tool", "left_torque_Nm", &cb_controller::left_torque_Nm},
    {"tool", "taring_s", &cb_controller::taring_s},
    {"tool", "gyration_m", &cb_controller::gyration_m},
    {"watch", "stale_s", &cb_controller::stale_s},
    {"watch", "give_up_s", &cb_controller::give_up_s},
    {"watch", "following_s", &cb_controller::following_s},
    {"watch", "max_tilt_rad", &cb_controller::max_tilt_rad},
};

void fill(double* to, const Json& array) {
    for (const Json& item : array.items) *to++ = item.number;
}

cb_controller read_controller(const Json& json) {
    cb_controller c{};
    c.aware = json["variant"].text == "aware";
    c.desired_force_N = json["desired_force_N"].number, c.period_s = json["period_s"].number;
    c.servo_lag_s = json["servo_lag_s"].number;
    for (const Gain& gain : gains) c.*gain.to = json[gain.part][gain.name].number;
    const Json& angle = json["angle"];
    fill(c.angle_inertia, angle["inertia"]), fill(c.angle_damping, angle["damping"]);
    fill(c.angle_stiffness, angle["stiffness"]), fill(c.angle_gain_per_s, angle["gain_per_s"]);
    fill(c.bandwidth_per_s, json["lead"]["bandwidth_per_s"]);
    c.attempts = std::int32_t(json["touch"]["attempts"].integer);
    return c;
}

void read_limits(const Json& limits, cb_controller& c, bool controlled) {
    c.max_force_N = limits["max_force_N"].number, c.max_torque_Nm = limits["max_torque_Nm"].number;
    const Json &speed = limits["max_speed_mps"], &turn = limits["max_turn_radps"];
    c.max_speed_mps = is_null(speed) ? HUGE_VAL : speed.number;
    c.max_turn_radps = is_null(turn) ? HUGE_VAL : turn.number;
    if (controlled && !(c.desired_force_N < c.max_force_N))
        fail(CB_ERROR_VALUE, "controller.desired_force_N", "not below limits.max_force_N");
}

bool passed(const Json& verification) {
    if (is_null(verification)) return false;
    return verification["passed"].boolean &&
           verification["mean_error_m"].number <= verification["limit_mean_m"].number &&
           verification["max_error_m"].number <= verification["limit_max_m"].number;
}

bool failed(const Json& check) { return !is_null(check) && check["outcome"].text == "failed"; }

void check_known_touch(const Json& touch) {
    if (!is_null(touch) && touch["outcome"].text == "passed" &&
        (is_null(touch["located_S_m"]) || is_null(touch["error_m"])))
        fail(CB_ERROR_VALUE, "checks.known_touch.outcome", "'passed', but nothing was located");
}

// What version 1 left open of a controller: as contactbench.pipeline.config.runtime.canonical has it. It had one gain for
// both turns.
constexpr std::string_view controller_of_old =
    R"({"variant":"aware","desired_force_N":0,"period_s":0.02,"servo_lag_s":0.0,)"
    R"("force":{"mass_kg":0,"damping_Nspm":0,"stiffness_Npm":0,"gain_per_s":6.0},)"
    R"("angle":{"inertia":[0,0],"damping":[0,0],"stiffness":[0,0],"gain_per_s":[6.0,6.0],"settling_s":0.04},)"
    R"("lead":{"bandwidth_per_s":[20.0,13.0,13.0],"smoothing_s":0.08,"lean_rad":0.025,"lean_s":0.8},)"
    R"("touch":{"approach_speed_mps":0.006,"approach_travel_m":0.05,"retract_speed_mps":0.06,)"
    R"("retract_travel_m":0.03,"touch_force_N":0.7,"low_force_N":0.7,"ramp_s":0.5,"probing_m":0.00015,"attempts":3},)"
    R"("tool":{"left_force_N":0.01,"left_torque_Nm":0.0005,"taring_s":0.5,"gyration_m":0.035},)"
    R"("watch":{"stale_s":0.06,"give_up_s":0.2,"following_s":0.05,"max_tilt_rad":0.5}})";

// What version 2 left open: as contactbench.pipeline.config.runtime.canonical has it.
constexpr std::string_view parts_of_2 =
    R"({"touch":{"torsion_arm_m":0.001,"model_error":{"force_N":[0.05,0.05,0.05],"torque_Nm":[0.001,0.001,0.001],)"
    R"("measured":false},"mesh_deviation_m":0.0,"mesh_curved":true},)"
    R"("streams":{"pose_gap_s":0.25,"pose_ahead_s":0.15,"silence_s":0.12,"frozen_probability":1e-10,"motion":null},)"
    R"("self_test":null})";
constexpr std::string_view gates_of_old =
    R"({"implausible_misfit":10.827566170662935,"rival_odds":100.0,"first_odds":7.38905609893065,)"
    R"("follow_odds":1000.0,"accept_by_region":true})";
constexpr std::string_view region_of_old[] = {R"({"odds":1000.0,"untouchable":false})",
                                              R"({"odds":100.0,"untouchable":false})",
                                              R"({"odds":10.0,"untouchable":false})"};  // the last for all that follow

Json& member(Json& object, std::string_view name) { return const_cast<Json&>(object[name]); }

constexpr Member gains_of_old[] = {
    {"desired_force_N", positive}, {"force_mass_kg", positive}, {"force_damping_Nspm", positive},
    {"force_stiffness_Npm", not_negative}, {"angle_inertia", positive}, {"angle_damping", positive},
    {"angle_stiffness", not_negative}};

// From version 1 to 2: the rest of the two is the same.
void from_1(Json& root) {
    const Json* found = root.find("controller");
    if (!found || is_null(*found)) return;
    check(*found, object(gains_of_old), "controller");
    const Json old = *found;
    Json made = parse_json(controller_of_old);
    member(made, "desired_force_N") = old["desired_force_N"];
    for (const char* name : {"mass_kg", "damping_Nspm", "stiffness_Npm"})
        member(member(made, "force"), name) = old[std::string("force_") + name];
    for (const char* name : {"inertia", "damping", "stiffness"})
        for (Json& turn : member(member(made, "angle"), name).items) turn = old[std::string("angle_") + name];
    member(root, "controller") = made;
}

void add(Json& object, std::string_view members) {
    for (auto& member : parse_json(members).members) object.members.push_back(std::move(member));
}

constexpr std::string_view doubt_of_old =
    R"("Bundles before version 3 were verified with other rules, which are gone: verify and export again.")";

// From version 2 to 3; nothing of version 3 may be there. It ranked touches by rules, and was verified with them.
void from_2(Json& root) {
    check_names(root, "",
                {"schema", "version", "units", "frames", "sensor", "gravity", "noise", "filters", "gates", "probe",
                 "regions", "planes", "controller", "limits", "verification", "verified", "provenance"});
    for (auto& [name, value] : root.members) {
        if (name == "gates") {
            check_names(value, "gates",
                        {"min_force_N", "friction_angle_rad", "ambiguity_distance_m", "torque_ratio", "rival_sigmas",
                         "follow_distance_m", "recent_samples", "max_age_s", "saturation", "region_only"});
            std::erase_if(value.members,
                          [](const auto& m) { return m.name == "torque_ratio" || m.name == "rival_sigmas"; });
            add(value, gates_of_old);
        }
        if (name == "verified") value.boolean = false;
        if (name == "provenance")
            if (auto* stale = const_cast<Json*>(value.find("stale"))) stale->items.push_back(parse_json(doubt_of_old));
        if (name != "regions") continue;
        for (std::size_t i = 0; i < value.items.size(); ++i) {
            check_names(value.items[i], "regions[" + std::to_string(i) + "]", {"rank", "name", "colour", "facets"});
            add(value.items[i], region_of_old[std::min(i, std::size(region_of_old) - 1)]);
        }
    }
    add(root, parts_of_2);
}

// What version 3 left open.
constexpr std::string_view parts_of_old =
    R"({"world":{"down_W":[0.0,0.0,-1.0]},"zero":{"measured":null,"drift":null},)"
    R"("checks":{"known_weight":null,"known_touch":null}})";

// From version 3 to 4; nothing of version 4 may be there. It took -z of W for down.
void from_3(Json& root) {
    check_names(root, "",
                {"schema", "version", "units", "frames", "sensor", "gravity", "noise", "touch", "streams", "filters",
                 "gates", "probe", "regions", "planes", "controller", "limits", "verification", "self_test", "verified",
                 "provenance"});
    Json &frames = member(root, "frames"), &noise = member(root, "noise");
    check_names(frames, "frames", {"sensor", "world", "rotation", "wrench", "quaternion_ES"});
    Json& world = member(frames, "world");
    check(world, one_of("W, z up"), "frames.world");
    world.text.assign(1, 'W');
    check_names(noise, "noise", {"force_N", "torque_Nm", "wrench_covariance"});
    noise.members.push_back({"orientation_rad", Json{}});
    add(root, parts_of_old);
}

}  // namespace

Config read_config(std::string_view text) {
    Json root = parse_json(text);
    if (root.type != Json::Type::object) fail(CB_ERROR_JSON, "the file", "not an object");
    Config c;
    c.version = read_kind(root);
    if (c.version < 3) from_2(root);
    if (c.version < 2) from_1(root);
    if (c.version < 4) from_3(root);
    check(root, object(schema::Runtime), "");
    read_frames(root["frames"], c);
    c.down_W = three(root["world"]["down_W"]);
    if (!(std::fabs(norm(c.down_W) - 1.0) <= 1e-9)) fail(CB_ERROR_VALUE, "world.down_W", "its length is not 1");
    c.sensor_model = root["sensor"]["model"].text, c.sensor_serial = root["sensor"]["serial"].text;
    c.rate = root["sensor"]["rate_Hz"].number;
    const auto calibration = read_gravity(root["gravity"], c);
    read_zero(root["zero"], c.settings);
    read_filters(root["filters"], root["noise"], c.settings);
    read_noise(root["noise"], c.settings, calibration);
    read_touch(root["touch"], c);
    read_streams(root["streams"], c.settings);
    each_gate(c.settings.gates, [&](const char* stored, const char*, auto& to, From from) {
        if (const Json* found = root["gates"].find(stored)) read_gate(*found, to, from);
    });
    read_probe_part(root["probe"], c);
    read_regions(root["regions"].items, c);
    read_planes(root["planes"], c);
    c.controlled = !is_null(root["controller"]);
    if (c.controlled) c.controller = read_controller(root["controller"]);
    read_limits(root["limits"], c.controller, c.controlled);
    if (const Json& test = root["self_test"]; !is_null(test))
        c.self_test = test["file"].text, c.self_test_samples = std::size_t(test["samples"].integer);
    const Json& checks = root["checks"];
    check_known_touch(checks["known_touch"]);
    for (const auto& [name, hash] : root["provenance"]["files"].members) c.files.emplace_back(name, hash.text);
    c.verified = root["verified"].boolean;
    const auto& stale = root["provenance"]["stale"].items;
    if (!stale.empty()) c.doubt = stale.front().text;
    if (c.verified && !(passed(root["verification"]) && stale.empty() &&
                        !failed(checks["known_weight"]) && !failed(checks["known_touch"])))
        fail(CB_ERROR_VALUE, "verified",
             "true, but the verification is missing, did not pass, or is stale, or a check failed");
    return c;
}

}  // namespace contactbench::runtime
