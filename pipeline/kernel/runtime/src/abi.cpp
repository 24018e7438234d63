// The C boundary: no exception crosses it, no NULL is followed.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <new>
#include <vector>

#include "bundle.hpp"
#include "environment.hpp"
#include "line.hpp"
#include "processor.hpp"
#include "self_test.hpp"

using contactbench::Runtime;
using contactbench::RuntimeContact;
using namespace contactbench::runtime;

struct cb_runtime {
    Runtime runtime;
    Config config;
    std::vector<std::uint8_t> marks;  // of each facet: CB_ON_*
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
              CB_UNHEALTHY == int(Reason::unhealthy) && CB_UNCERTAIN == int(Reason::uncertain) &&
              CB_UNCERTAIN + 1 == contactbench::reason_count);
using contactbench::Flag;
using contactbench::Health;
static_assert(CB_HEALTH_FROZEN == Health::frozen && CB_HEALTH_SILENT == Health::silent &&
              CB_HEALTH_FLAGGED == Health::flagged && CB_HEALTH_NO_POSE == Health::no_pose &&
              CB_HEALTH_CLOCK == Health::clock && CB_FLAG_OVERRANGE == Flag::overrange &&
              CB_FLAG_LATE == Flag::late && CB_FLAG_CLOCK == Flag::clock_leapt);
using contactbench::ZeroState;
using contactbench::Follows;
static_assert(CB_FOLLOWS_OFF == int(Follows::off) && CB_FOLLOWS_STOPPED == int(Follows::stopped));
static_assert(CB_ZERO_UNKNOWN == int(ZeroState::unknown) && CB_ZERO_CONFIRMED == int(ZeroState::confirmed) &&
              CB_ZERO_DOUBTFUL == int(ZeroState::doubtful) && CB_ZERO_OFF == int(ZeroState::off));

// As they were when they first came: what a caller has room for at least. They only grow, at the end.
constexpr std::size_t error_2_0 = 520, contact_2_0 = 336, sample_2_0 = 72, info_2_0 = 432, controller_2_0 = 352;
constexpr std::size_t zero_2_1 = 128;
static_assert(sizeof(cb_error) >= error_2_0 && sizeof(cb_contact) >= contact_2_0 && sizeof(cb_sample) >= sample_2_0 &&
              sizeof(cb_info) >= info_2_0 && sizeof(cb_controller) >= controller_2_0 && sizeof(cb_zero) >= zero_2_1);

// As many members as both sides know; `size` stays the caller's.
template <class Struct>
void hand_over(const Struct& from, Struct* to) noexcept {
    constexpr std::size_t head = sizeof to->size;
    const std::size_t size = std::min<std::size_t>(to->size, sizeof from);
    std::memcpy(reinterpret_cast<char*>(to) + head, reinterpret_cast<const char*>(&from) + head, size - head);
}

// `reason` and `accepted` have the same place in every version of the struct: they can be told whatever the size says.
int nothing(cb_contact* contact) noexcept {
    if (contact) contact->reason = CB_NO_ANSWER, contact->accepted = 0;
    return CB_ERROR_ARGUMENT;
}

void tell(cb_error* error, int code, const char* message) noexcept {
    if (!error || error->size < error_2_0) return;
    error->code = code;
    std::snprintf(error->message, sizeof error->message, "%s", message);
}

// Returns what `load` threw, by its code; `error` says it in words.
template <class Load>
int attempt(const char* folder, cb_error* error, Load&& load) noexcept {
    if (error && error->size < error_2_0) return CB_ERROR_ARGUMENT;
    const auto failed = [&](int code, const char* message) { return tell(error, code, message), code; };
    tell(error, CB_OK, "");
    const Environment ours;
    if (!folder) return failed(CB_ERROR_ARGUMENT, "the folder is NULL; give the path of a bundle");
    if (!processor_suits(needs_avx2))
        return failed(CB_ERROR_PROCESSOR,
                      "this processor has no AVX2; build the library with -DCONTACTBENCH_MARCH=x86-64");
    try {
        load();
        return CB_OK;
    } catch (const LoadError& e) {
        return failed(e.code(), e.what());
    } catch (const std::bad_alloc&) {
        return failed(CB_ERROR_MEMORY, "not enough memory for this probe; simplify it");
    } catch (const std::exception& e) {  // of the file system: no path that it can hold
        return failed(CB_ERROR_FILE, e.what());
    } catch (...) {
        return failed(CB_ERROR_FILE, "the bundle cannot be read; copy or export it again");
    }
}

template <std::size_t N>
void copy_text(char (&to)[N], const std::string& from) noexcept {
    std::snprintf(to, N, "%s", from.c_str());
}

void fill(cb_contact* contact, const cb_runtime& runtime, const RuntimeContact& c) noexcept {
    hand_over(to_c(c, c.face < 0 ? CB_ON_NOTHING : runtime.marks[std::size_t(c.face)]), contact);
}

bool fits(const cb_contact* contact) noexcept { return contact && contact->size >= contact_2_0; }

}  // namespace

extern "C" {

cb_runtime* cb_open(const char* folder, cb_error* error) {
    cb_runtime* made = nullptr;
    attempt(folder, error, [&] {
        Bundle bundle = load_bundle(folder);
        Runtime runtime(bundle.model, bundle.config.settings);
        made = new cb_runtime{std::move(runtime), std::move(bundle.config), std::move(bundle.marks)};
    });
    return made;
}

int cb_selftest(const char* folder, cb_error* error) {
    return attempt(folder, error, [&] { replay_self_test(folder); });
}

int cb_update(cb_runtime* runtime, const double wrench[6], const double R_WS[9], double time, cb_contact* contact) {
    if (!runtime || !wrench || !R_WS || !fits(contact)) return nothing(contact);
    const Environment ours;
    fill(contact, *runtime, runtime->runtime.update(wrench, R_WS, time));
    return CB_OK;
}

int cb_pose(cb_runtime* runtime, const double R[9], const double* p_W, double time) {
    if (!runtime || !R) return CB_ERROR_ARGUMENT;
    const Environment ours;
    return runtime->runtime.pose(R, p_W, time) ? CB_OK : CB_ERROR_VALUE;
}

int cb_update_sample(cb_runtime* runtime, const cb_sample* sample, cb_contact* contact) {
    if (!runtime || !sample || sample->size < sample_2_0 || !fits(contact)) return nothing(contact);
    const Environment ours;
    contactbench::RuntimeSample given{};
    copy(given.wrench, sample->wrench, 6);
    given.time = sample->time, given.arrival = sample->arrival, given.flags = sample->flags;
    fill(contact, *runtime, runtime->runtime.update(given));
    return CB_OK;
}

int cb_check(const cb_runtime* runtime, double now, cb_contact* contact) {
    if (!runtime || !fits(contact)) return nothing(contact);
    const Environment ours;
    RuntimeContact found;
    if (!runtime->runtime.silent(now, found)) found.reason = CB_NO_ANSWER;
    fill(contact, *runtime, found);
    return CB_OK;
}

int cb_check_zero(const cb_runtime* runtime, cb_zero* zero) {
    if (!runtime || !zero || zero->size < zero_2_1) return CB_ERROR_ARGUMENT;
    const Environment ours;
    hand_over(to_c(runtime->runtime.zero()), zero);
    return CB_OK;
}

int cb_line(const cb_contact* contact, const cb_zero* zero, char* text, uint32_t room) {
    if (!fits(contact) || !zero || zero->size < zero_2_1 || !text) return 0;
    cb_contact c = CB_CONTACT_INIT;
    cb_zero z = CB_ZERO_INIT;
    c.within = c.torsion_arm = c.torsion_since = contactbench::detail::unknown;  // a caller of 2.0 has none
    std::memcpy(&c, contact, std::min<std::size_t>(contact->size, sizeof c));
    std::memcpy(&z, zero, std::min<std::size_t>(zero->size, sizeof z));
    const Environment ours;
    const Line line(c, z);
    if (line.view().size() >= room) return 0;
    text[line.view().copy(text, room)] = '\0';
    return int(line.view().size());
}

int cb_sensor_rotation(const cb_runtime* runtime, const double R_WE[9], double R_WS[9]) {
    if (!runtime || !R_WE || !R_WS) return CB_ERROR_ARGUMENT;
    if (!runtime->config.R_ES) return CB_ERROR_VALUE;
    const Environment ours;
    const auto& R_ES = *runtime->config.R_ES;
    double product[9] = {};  // R_WS may be R_WE
    for (std::size_t r = 0; r < 3; ++r)
        for (std::size_t c = 0; c < 3; ++c)
            for (std::size_t k = 0; k < 3; ++k) product[3 * r + c] += R_WE[3 * r + k] * R_ES[3 * k + c];
    copy(R_WS, product, 9);
    return CB_OK;
}

int cb_describe(const cb_runtime* runtime, cb_info* info) {
    if (!runtime || !info || info->size < info_2_0) return CB_ERROR_ARGUMENT;
    const Config& c = runtime->config;
    cb_info out{};
    out.verified = c.verified;
    out.facets = std::int32_t(c.facets), out.vertices = std::int32_t(c.vertices);
    out.rate_Hz = c.rate, out.max_age_s = c.settings.gates.max_age;
    out.max_force_N = c.controller.max_force_N, out.max_torque_Nm = c.controller.max_torque_Nm;
    copy_text(out.sensor_model, c.sensor_model), copy_text(out.sensor_serial, c.sensor_serial);
    copy_text(out.probe, c.probe_name);
    copy_text(out.doubt, c.doubt);
    hand_over(out, info);
    return CB_OK;
}

int cb_describe_controller(const cb_runtime* runtime, cb_controller* controller) {
    if (!runtime || !controller || controller->size < controller_2_0) return CB_ERROR_ARGUMENT;
    const Config& c = runtime->config;
    cb_controller out = c.controller;
    if (!c.controlled) {  // what is not told stays as it was
        std::memcpy(&out, controller, std::min<std::size_t>(controller->size, sizeof out));
        out.max_force_N = c.controller.max_force_N, out.max_torque_Nm = c.controller.max_torque_Nm;
        out.max_speed_mps = c.controller.max_speed_mps, out.max_turn_radps = c.controller.max_turn_radps;
    }
    hand_over(out, controller);
    return c.controlled ? CB_OK : CB_ERROR_VALUE;
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
