// The C boundary: no exception crosses it, no NULL is followed.
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <new>

#include "bundle.hpp"
#include "processor.hpp"

using contactbench::Runtime;
using contactbench::RuntimeContact;
using namespace contactbench::runtime;

struct cb_runtime {
    Runtime runtime;
    Config config;
};

namespace {

#if defined(__AVX2__)
constexpr bool needs_avx2 = true;
#else
constexpr bool needs_avx2 = false;
#endif

using contactbench::Reason;
static_assert(CB_OK_FACET == int(Reason::ok) && CB_NOT_A_ROTATION == int(Reason::not_a_rotation) &&
              CB_BY_REGION == int(Reason::by_region) && CB_IMPLAUSIBLE == int(Reason::implausible) &&
              CB_TWO_TOUCHES == int(Reason::two_touches) && CB_TWO_TOUCHES + 1 == contactbench::reason_count);

// `reason` and `accepted` have the same place in every version of the struct: they can be told whatever the size says.
int nothing(cb_contact* contact) noexcept {
    if (contact) contact->reason = CB_NO_ANSWER, contact->accepted = 0;
    return CB_ERROR_ARGUMENT;
}

void tell(cb_error* error, int code, const char* message) noexcept {
    if (!error || error->size != sizeof(cb_error)) return;
    error->code = code;
    std::snprintf(error->message, sizeof error->message, "%s", message);
}

template <std::size_t N>
void copy_text(char (&to)[N], const std::string& from) noexcept {
    std::snprintf(to, N, "%s", from.c_str());
}

void copy(double* to, const double* from, int n) noexcept { std::copy(from, from + n, to); }

// Member by member: each of the two structs may grow on its own.
void fill(cb_contact& out, const RuntimeContact& c) noexcept {
    out.reason = c.reason, out.accepted = c.accepted;
    out.face = c.face, out.vertex = c.vertex;
    out.region = c.region, out.candidates = c.candidates, out.reserved = 0;
    out.time = c.time;
    copy(out.point, c.point, 3), copy(out.normal, c.normal, 3);
    out.torque_about_normal = c.torque_about_normal;
    copy(out.force, c.wrench, 3), copy(out.torque, c.wrench + 3, 3);
    copy(out.covariance, c.covariance, 9), copy(out.filtered_point, c.filtered_point, 3);
    out.misfit = c.misfit, out.left_over = c.left_over, out.arm = c.arm, out.confidence = c.confidence;
    copy(out.runner_up, c.runner_up, 3), copy(out.second, c.second, 3);
}

template <std::size_t N>
void copy(double (&to)[N], const std::array<double, N>& from) noexcept {
    std::copy(from.begin(), from.end(), to);
}

void fill_gains(cb_controller& out, const Controller& c) noexcept {
    out.desired_force_N = c.desired_force, out.period_s = c.period, out.servo_lag_s = c.servo_lag;
    out.force_mass_kg = c.force_mass, out.force_damping_Nspm = c.force_damping;
    out.force_stiffness_Npm = c.force_stiffness, out.force_gain_per_s = c.force_gain;
    copy(out.angle_inertia, c.angle_inertia), copy(out.angle_damping, c.angle_damping);
    copy(out.angle_stiffness, c.angle_stiffness), copy(out.angle_gain_per_s, c.angle_gain);
    out.settling_s = c.settling;
    copy(out.bandwidth_per_s, c.bandwidth);
    out.smoothing_s = c.smoothing, out.lean_rad = c.lean_angle, out.lean_s = c.lean_time;
}

void fill_behaviour(cb_controller& out, const Controller& c) noexcept {
    out.approach_speed_mps = c.approach_speed, out.approach_travel_m = c.approach_travel;
    out.retract_speed_mps = c.retract_speed, out.retract_travel_m = c.retract_travel;
    out.touch_force_N = c.touch_force, out.low_force_N = c.low_force;
    out.ramp_s = c.ramp, out.probing_m = c.probing, out.attempts = std::int32_t(c.attempts);
    out.left_force_N = c.left_force, out.left_torque_Nm = c.left_torque;
    out.taring_s = c.taring, out.gyration_m = c.gyration;
    out.stale_s = c.stale, out.give_up_s = c.give_up, out.following_s = c.following;
    out.max_tilt_rad = c.max_tilt;
}

}  // namespace

extern "C" {

cb_runtime* cb_open(const char* folder, cb_error* error) {
    if (error && error->size != sizeof(cb_error)) return nullptr;
    tell(error, CB_OK, "");
    if (!folder) return tell(error, CB_ERROR_ARGUMENT, "the folder is NULL; give the path of a bundle"), nullptr;
    if (!processor_suits(needs_avx2))
        return tell(error, CB_ERROR_PROCESSOR,
                    "this processor has no AVX2; build the library with -DCONTACTBENCH_MARCH=x86-64"),
               nullptr;
    try {
        Bundle bundle = load_bundle(folder);
        Runtime runtime(bundle.model, bundle.config.settings);
        return new cb_runtime{std::move(runtime), std::move(bundle.config)};
    } catch (const LoadError& e) {
        tell(error, e.code(), e.what());
    } catch (const std::bad_alloc&) {
        tell(error, CB_ERROR_MEMORY, "not enough memory for this probe; simplify it");
    } catch (const std::exception& e) {  // of the file system: no path that it can hold
        tell(error, CB_ERROR_FILE, e.what());
    } catch (...) {
        tell(error, CB_ERROR_FILE, "the bundle cannot be read; copy or export it again");
    }
    return nullptr;
}

int cb_update(cb_runtime* runtime, const double wrench[6], const double R_WS[9], double time, cb_contact* contact) {
    if (!runtime || !wrench || !R_WS || !contact || contact->size != sizeof(cb_contact)) return nothing(contact);
    fill(*contact, runtime->runtime.update(wrench, R_WS, time));
    return CB_OK;
}

int cb_sensor_rotation(const cb_runtime* runtime, const double R_WE[9], double R_WS[9]) {
    if (!runtime || !R_WE || !R_WS) return CB_ERROR_ARGUMENT;
    if (!runtime->config.R_ES) return CB_ERROR_VALUE;
    const auto& R_ES = *runtime->config.R_ES;
    double product[9] = {};  // R_WS may be R_WE
    for (std::size_t r = 0; r < 3; ++r)
        for (std::size_t c = 0; c < 3; ++c)
            for (std::size_t k = 0; k < 3; ++k) product[3 * r + c] += R_WE[3 * r + k] * R_ES[3 * k + c];
    copy(R_WS, product, 9);
    return CB_OK;
}

int cb_describe(const cb_runtime* runtime, cb_info* info) {
    if (!runtime || !info || info->size != sizeof(cb_info)) return CB_ERROR_ARGUMENT;
    const Config& c = runtime->config;
    info->verified = c.verified;
    info->facets = std::int32_t(c.facets), info->vertices = std::int32_t(c.vertices);
    info->rate_Hz = c.rate, info->max_age_s = c.settings.gates.max_age;
    info->max_force_N = c.max_force, info->max_torque_Nm = c.max_torque;
    copy_text(info->sensor_model, c.sensor_model), copy_text(info->sensor_serial, c.sensor_serial);
    copy_text(info->probe, c.probe_name);
    return CB_OK;
}

int cb_describe_controller(const cb_runtime* runtime, cb_controller* out) {
    if (!runtime || !out || out->size != sizeof(cb_controller)) return CB_ERROR_ARGUMENT;
    const Config& c = runtime->config;
    out->max_force_N = c.max_force, out->max_torque_Nm = c.max_torque;
    out->max_speed_mps = c.max_speed, out->max_turn_radps = c.max_turn;
    if (!c.controller) return CB_ERROR_VALUE;
    out->aware = c.controller->aware, out->reserved = 0;
    fill_gains(*out, *c.controller);
    fill_behaviour(*out, *c.controller);
    return CB_OK;
}

int cb_reset(cb_runtime* runtime) {
    if (!runtime) return CB_ERROR_ARGUMENT;
    runtime->runtime.reset();
    return CB_OK;
}

void cb_close(cb_runtime* runtime) { delete runtime; }

const char* cb_version(void) { return CB_RUNTIME_VERSION; }

const char* cb_reason_name(int reason) {
    return reason == CB_NO_ANSWER ? "no_answer" : contactbench::reason_name(reason);
}

}  // extern "C"
