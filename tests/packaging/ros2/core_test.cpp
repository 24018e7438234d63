// core_test BUNDLE UNVERIFIED READINGS
#include <contactbench_ros/node_core.hpp>

#include <cstring>
#include <new>

#include "readings.hpp"

namespace {

long allocations = 0;

}  // namespace

void* operator new(std::size_t size) {
    ++allocations;
    if (void* made = std::malloc(size ? size : 1)) return made;
    throw std::bad_alloc();
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
    ++allocations;
    return std::malloc(size ? size : 1);
}
void operator delete(void* given) noexcept { std::free(given); }
void operator delete(void* given, std::size_t) noexcept { std::free(given); }

namespace {

using namespace contactbench_ros;

constexpr double level[4] = {0, 0, 0, 1}, nowhere[3] = {NAN, NAN, NAN};
constexpr double begin = 1'700'000'000.0;

// Half a second at 1 kHz, with a pose every 10 ms if `posed`.
struct Stream {
    NodeCore& core;
    double time = begin;
    Answer answer{};
    long published = 0, accepted = 0, stale = 0;

    void run(const double reading[6], int count = 500, bool posed = true, const double* xyzw = level) {
        published = accepted = stale = 0;
        for (int i = 0; i < count; ++i) {
            if (posed && i % 10 == 0) CHECK(core.pose("base", time, nowhere, xyzw) == Taken::used);
            double w[6];
            noisy(reading, w);
            CHECK(core.wrench("ft", time, time + 0.002, w, answer) == Taken::used);
            published += answer.publish_contact;
            accepted += answer.contact.accepted;
            stale += answer.contact.reason == CB_STALE;
            time += 0.001;
        }
    }
};

Settings settings_of(const char* bundle) {
    Settings settings;
    settings.bundle = bundle, settings.sensor_frame = "ft", settings.world_frame = "base";
    return settings;
}

NodeCore opened(const Settings& settings) {
    NodeCore core;
    std::string error;
    CHECK(core.open(settings, error));
    if (!error.empty()) std::puts(error.c_str());
    core.start();
    return core;
}

bool says(const std::string& text, const char* part) {
    const bool there = text.find(part) != std::string::npos;
    if (!there) std::printf("'%s' is not in: %s\n", part, text.c_str());
    return there;
}

void what_cannot_be_opened_says_why(const char* bundle, const char* unverified) {
    NodeCore core;
    std::string error;
    CHECK(!core.open(settings_of("/nowhere/bundle"), error));
    CHECK(says(error, "parameter bundle: /nowhere/bundle: no such folder"));
    for (const char* field : {"bundle", "sensor_frame", "world_frame"}) {
        Settings settings = settings_of(bundle);
        (field[0] == 'b' ? settings.bundle : field[0] == 's' ? settings.sensor_frame : settings.world_frame).clear();
        CHECK(!core.open(settings, error) && !core.is_open());
        CHECK(says(error, field));
    }
    Settings trial = settings_of(unverified);
    CHECK(!core.open(trial, error) && !core.is_open());
    CHECK(says(error, "is not verified"));
    trial.accept_unverified = true;
    CHECK(core.open(trial, error));
    double reading[6] = {};
    Answer answer;
    CHECK(core.wrench("ft", begin, begin, reading, answer) == Taken::inactive);
    CHECK(core.pose("base", begin, nowhere, level) == Taken::inactive);
    CHECK(!core.silence(begin, answer));
    CHECK(!core.zero().trusted);
}

// The same as the runtime by itself, to the bit.
void a_touch_is_located(const char* bundle, const Readings& readings) {
    NodeCore core = opened(settings_of(bundle));
    cb_runtime* alone = cb_open(bundle, nullptr);
    const double R[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    Answer answer;
    long accepted = 0;
    for (int i = 0; i < 500; ++i) {
        const double time = begin + 0.001 * i;
        if (i % 10 == 0) {
            core.pose("base", time, nowhere, level);
            cb_pose(alone, R, nowhere, time);
        }
        cb_sample sample = CB_SAMPLE_INIT;
        noisy(readings.touched, sample.wrench);
        sample.time = time, sample.arrival = time + 0.002;
        cb_contact expected = CB_CONTACT_INIT;
        cb_update_sample(alone, &sample, &expected);
        core.wrench("ft", time, sample.arrival, sample.wrench, answer);
        CHECK(std::memcmp(&answer.contact, &expected, sizeof expected) == 0);
        accepted += expected.accepted;
        CHECK(answer.has_wrench());
    }
    CHECK(accepted > 400);
    CHECK(answer.has_point() && answer.health_count == 0);
    CHECK(std::fabs(answer.contact.latency - 0.072) < 2e-3);  // 2 ms, and the filter of the bundle
    CHECK(std::strcmp(answer.reason(), "ok") == 0 || std::strcmp(answer.reason(), "by_region") == 0);
    cb_close(alone);
}

void a_tilted_probe_weighs_nothing(const char* bundle, const Readings& readings) {
    NodeCore core = opened(settings_of(bundle));
    Stream stream{core};
    stream.run(readings.tilted, 500, true, readings.tilted_xyzw);
    for (const double f : stream.answer.contact.force) CHECK(std::fabs(f) < 0.1);
    CHECK(stream.answer.contact.reason == CB_LOW_FORCE);
}

void without_a_young_pose_nothing_is_accepted(const char* bundle, const Readings& readings) {
    NodeCore core = opened(settings_of(bundle));
    Stream stream{core};
    stream.run(readings.touched, 100, false);
    CHECK(stream.stale == 100 && stream.accepted == 0);
    CHECK(stream.answer.health_count == 1 && std::strcmp(stream.answer.health[0], "no_pose") == 0);
    CHECK(core.status(stream.time).level == Level::error);
    stream.run(readings.touched);
    CHECK(stream.accepted > 400);
    stream.run(readings.touched, 1'000, false);  // the last pose is carried on for a moment, then it is too old
    CHECK(stream.accepted > 50 && stream.accepted < 300 && stream.stale == 1'000 - stream.accepted);
    const Status status = core.status(stream.time);
    CHECK(status.level == Level::warn && says(status.message, "no pose"));
}

void a_clock_that_is_set_back_starts_anew(const char* bundle, const Readings& readings) {
    NodeCore core = opened(settings_of(bundle));
    Stream stream{core};
    stream.run(readings.touched);
    stream.time -= 100.0;
    stream.run(readings.touched);
    CHECK(stream.stale >= 1 && stream.stale <= 60);
    CHECK(stream.accepted > 350);
}

void what_is_no_reading_is_told(const char* bundle, const Readings& readings) {
    NodeCore core = opened(settings_of(bundle));
    Stream stream{core};
    stream.run(readings.touched);
    double broken[6];
    noisy(readings.touched, broken);
    broken[4] = NAN;
    CHECK(core.wrench("ft", stream.time, stream.time, broken, stream.answer) == Taken::used);
    CHECK(stream.answer.contact.reason == CB_NOT_FINITE && !stream.answer.contact.accepted);
    CHECK(stream.answer.publish_contact && !stream.answer.has_wrench() && !stream.answer.publish_wrench);
    CHECK(core.wrench("ft", 0.0, stream.time, readings.touched, stream.answer) == Taken::no_time);
    CHECK(core.wrench("ft", -1.0, stream.time, readings.touched, stream.answer) == Taken::no_time);
    CHECK(core.pose("base", -1.0, nowhere, level) == Taken::no_time);
    CHECK(says(core.status(stream.time).message, "no time stamp"));
    stream.time += 0.001;
    stream.run(readings.touched, 10);
    CHECK(stream.accepted == 10);
    const double longer[4] = {0, 0, 0, 1.01}, unknown[4] = {0, NAN, 0, 1};
    CHECK(core.pose("base", stream.time, nowhere, longer) == Taken::refused);
    CHECK(core.pose("base", stream.time, nowhere, unknown) == Taken::refused);
    CHECK(core.pose("base", stream.time, nowhere, level) == Taken::used);
    CHECK(core.pose("base", stream.time, nowhere, level) == Taken::refused);  // not later
    CHECK(says(core.status(stream.time).message, "poses"));
}

void another_frame_is_not_used(const char* bundle, const Readings& readings) {
    NodeCore core = opened(settings_of(bundle));
    Stream stream{core};
    stream.run(readings.touched);
    CHECK(core.status(stream.time).level == Level::ok);
    CHECK(core.wrench("/ft", stream.time, stream.time, readings.touched, stream.answer) == Taken::used);
    stream.answer.contact.time = -1.0;
    CHECK(core.wrench("wrist", stream.time + 0.001, stream.time, readings.touched, stream.answer) ==
          Taken::wrong_frame);
    CHECK(stream.answer.contact.time == -1.0);
    Status status = core.status(stream.time);
    CHECK(status.level == Level::error);
    CHECK(says(status.message, "the wrench is 'wrist'") && says(status.message, "sensor_frame is 'ft'"));
    CHECK(core.status(stream.time).level == Level::ok);  // it is of the time since the last call
    CHECK(core.pose("odom", stream.time, nowhere, level) == Taken::wrong_frame);
    CHECK(says(core.status(stream.time).message, "the pose is 'odom'"));
}

void silence_is_told(const char* bundle, const Readings& readings) {
    Settings settings = settings_of(bundle);
    settings.contact_rate = 0.1;  // no limit for this
    NodeCore core = opened(settings);
    Stream stream{core};
    CHECK(core.silence(begin, stream.answer));  // before the first reading
    stream.run(readings.touched);
    CHECK(!core.silence(stream.time + 0.05, stream.answer));
    CHECK(core.silence(stream.time + 0.4, stream.answer) && stream.answer.publish_contact);
    CHECK(core.silence(stream.time + 0.5, stream.answer));
    CHECK(stream.answer.publish_contact && !stream.answer.contact.accepted && !stream.answer.has_wrench());
    CHECK(stream.answer.health_count == 1 && std::strcmp(stream.answer.health[0], "silent") == 0);
    CHECK(says(core.status(stream.time + 0.5).message, "No wrench comes"));
}

void active_again_it_is_new(const char* bundle, const Readings& readings) {
    NodeCore core = opened(settings_of(bundle));
    Stream stream{core};
    stream.run(readings.touched);
    core.stop();
    CHECK(core.wrench("ft", stream.time, stream.time, readings.touched, stream.answer) == Taken::inactive);
    core.start();
    stream.run(readings.touched, 5, false);
    CHECK(stream.stale == 5);  // the poses of before are forgotten
    stream.time = begin;       // and so is the time
    stream.run(readings.touched);
    CHECK(stream.accepted > 400);
    core.close();
    CHECK(!core.is_open() && !core.is_active());
    core.start();
    CHECK(!core.is_active());
}

void a_rate_limit_keeps_changes(const char* bundle, const Readings& readings) {
    Settings settings = settings_of(bundle);
    settings.contact_rate = 100.0;
    NodeCore core = opened(settings);
    Stream stream{core};
    stream.run(readings.touched);
    stream.run(readings.touched);
    CHECK(stream.published >= 48 && stream.published <= 60);
    double broken[6] = {NAN, 0, 0, 0, 0, 0};
    Answer answer;
    core.wrench("ft", stream.time + 0.0001, stream.time, broken, answer);
    CHECK(answer.publish_contact);
    broken[1] = 1;
    core.wrench("ft", stream.time + 0.0002, stream.time, broken, answer);
    CHECK(!answer.publish_contact);  // the same reason, and too soon
    for (int i = 0; i < 3; ++i) {  // a clock that is set back does not silence it
        core.wrench("ft", stream.time - 50.0 + i, stream.time, broken, answer);
        CHECK(answer.publish_contact);
    }
}

void the_zero_is_told_and_never_touched(const char* bundle, const Readings& readings) {
    NodeCore core = opened(settings_of(bundle));
    Stream stream{core};
    stream.run(readings.free, 20);
    CHECK(!core.zero().trusted && says(core.zero().message, "not known yet"));
    stream.run(readings.free, 2'000);
    CHECK(core.zero().trusted && says(core.zero().message, "was confirmed"));
    CHECK(says(core.zero().message, "Nothing was changed"));
    double shifted[6];
    std::copy(readings.free, readings.free + 6, shifted);
    shifted[0] += 0.5;
    core.start();
    stream.run(shifted, 2'000);
    CHECK(!core.zero().trusted && says(core.zero().message, "Lift the probe clear"));
    CHECK(says(core.zero().message, "reads 0.5 ± "));
}

void nothing_is_allocated(const char* bundle, const Readings& readings) {
    NodeCore core = opened(settings_of(bundle));
    Answer answer;
    const long before = allocations;
    for (int i = 0; i < 2'000; ++i) {
        const double time = begin + 0.001 * i;
        if (i % 10 == 0 && i < 1'500) core.pose("base", time, nowhere, level);
        double w[6];
        noisy(i % 400 < 200 ? readings.touched : readings.free, w);
        if (i % 97 == 0) w[2] = NAN;
        core.wrench(i % 89 == 0 ? "a frame with a name that is longer than any short string" : "ft", time, time, w, answer);
        core.silence(time + (i % 50 == 0), answer);
    }
    CHECK(allocations == before);
}

void another_rate_is_told(const char* bundle, const Readings& readings) {
    NodeCore core = opened(settings_of(bundle));
    Answer answer;
    double time = begin;
    for (int i = 0; i < 500; ++i, time += 0.002) {
        core.pose("base", time, nowhere, level);
        double w[6];
        noisy(readings.free, w);
        core.wrench("ft", time, time, w, answer);
    }
    const Status status = core.status(time);
    CHECK(status.level == Level::warn && says(status.message, "500 Hz, but the bundle is for 1000 Hz"));
}

}  // namespace

int main(int, char** argv) {
    const char* bundle = argv[1];
    const Readings readings(argv[3]);
    what_cannot_be_opened_says_why(bundle, argv[2]);
    a_touch_is_located(bundle, readings);
    a_tilted_probe_weighs_nothing(bundle, readings);
    without_a_young_pose_nothing_is_accepted(bundle, readings);
    a_clock_that_is_set_back_starts_anew(bundle, readings);
    what_is_no_reading_is_told(bundle, readings);
    another_frame_is_not_used(bundle, readings);
    silence_is_told(bundle, readings);
    active_again_it_is_new(bundle, readings);
    a_rate_limit_keeps_changes(bundle, readings);
    the_zero_is_told_and_never_touched(bundle, readings);
    nothing_is_allocated(bundle, readings);
    another_rate_is_told(bundle, readings);
    return result();
}
