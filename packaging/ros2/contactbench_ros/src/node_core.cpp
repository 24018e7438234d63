#include "contactbench_ros/node_core.hpp"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <cstring>

namespace contactbench_ros {

namespace {

// From the lowest bit: what cb_contact.health calls wrong.
constexpr std::array<const char*, 5> health_names{"frozen", "silent", "flagged", "no_pose", "clock"};
constexpr std::array<const char*, 4> zero_states{"unknown", "confirmed", "doubtful", "off"};
constexpr double longest_quaternion_error = 1e-3;
constexpr double largest_rate_error = 0.05;  // beyond, filters and figures of the bundle do not hold
constexpr double shortest_look = 0.5;        // s: over less, a rate says nothing

template <std::size_t N>
void print(std::array<char, N>& to, const char* format, ...) noexcept {
    std::va_list values;
    va_start(values, format);
    std::vsnprintf(to.data(), N, format, values);
    va_end(values);
}

std::string formatted(const char* format, ...) {
    std::array<char, 512> text{};
    std::va_list values;
    va_start(values, format);
    std::vsnprintf(text.data(), text.size(), format, values);
    va_end(values);
    return text.data();
}

std::string_view bare(std::string_view frame) noexcept {
    while (!frame.empty() && frame.front() == '/') frame.remove_prefix(1);
    return frame;
}

double length(const double v[3]) noexcept { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

// The spread of the length of `v`, whose parts spread by `sigma`.
double spread(const double v[3], const double sigma[3]) noexcept {
    const double size = length(v);
    const double along[3] = {v[0] * sigma[0], v[1] * sigma[1], v[2] * sigma[2]};
    return size > 0.0 ? length(along) / size : 0.0;
}

std::string sizes(const cb_zero& zero) {
    return formatted("%.2g ± %.1g N and %.2g ± %.1g mN·m", length(zero.force), spread(zero.force, zero.force_sigma),
                     1e3 * length(zero.torque), 1e3 * spread(zero.torque, zero.torque_sigma));
}

// False: no rotation.
bool rotation_of(const double xyzw[4], double R[9]) noexcept {
    const double n = std::sqrt(xyzw[0] * xyzw[0] + xyzw[1] * xyzw[1] + xyzw[2] * xyzw[2] + xyzw[3] * xyzw[3]);
    if (!(std::fabs(n - 1.0) <= longest_quaternion_error)) return false;
    const double x = xyzw[0] / n, y = xyzw[1] / n, z = xyzw[2] / n, w = xyzw[3] / n;
    R[0] = 1 - 2 * (y * y + z * z), R[1] = 2 * (x * y - z * w), R[2] = 2 * (x * z + y * w);
    R[3] = 2 * (x * y + z * w), R[4] = 1 - 2 * (x * x + z * z), R[5] = 2 * (y * z - x * w);
    R[6] = 2 * (x * z - y * w), R[7] = 2 * (y * z + x * w), R[8] = 1 - 2 * (x * x + y * y);
    return true;
}

}  // namespace

bool Answer::has_wrench() const noexcept { return std::isfinite(contact.force[0]) && contact.reason != CB_NO_ANSWER; }

bool Answer::has_point() const noexcept { return contact.face >= 0 && std::isfinite(contact.point[0]); }

bool NodeCore::Limiter::due(double time) noexcept {
    // Also after the clock was set back. A millionth of a second: stamps at the very rate all count.
    if (time >= last_ && time - last_ < period_ - 1e-6) return false;
    last_ = time;
    return true;
}

bool NodeCore::open(const Settings& settings, std::string& error) {
    close();
    const std::pair<const std::string&, const char*> needed[] = {
        {settings.bundle, "bundle: give the folder that `contactbench bundle export` wrote"},
        {settings.sensor_frame, "sensor_frame: give the frame_id of the wrenches"},
        {settings.world_frame, "world_frame: give the frame that the calibration's orientations were given in, normally "
                               "the robot's base"}};
    for (const auto& [value, missing] : needed)
        if (value.empty()) return error = std::string("parameter ") + missing, false;
    cb_error said = CB_ERROR_INIT;
    runtime_.reset(cb_open(settings.bundle.c_str(), &said));
    const bool passed = runtime_ && (!settings.self_test || cb_selftest(settings.bundle.c_str(), &said) == CB_OK);
    if (!passed) {
        close();
        return error = std::string("parameter bundle: ") + said.message, false;
    }
    info_ = {};
    info_.size = sizeof info_;
    cb_describe(runtime_.get(), &info_);
    if (!info_.verified && !settings.accept_unverified) {
        close();
        error = "parameter bundle: " + settings.bundle + " is not verified: verify and export it again, or set "
                "accept_unverified for trials without a person";
        return false;
    }
    settings_ = settings;
    contacts_.set(settings.contact_rate), wrenches_.set(settings.wrench_rate), markers_.set(settings.marker_rate);
    return true;
}

void NodeCore::close() noexcept {
    active_ = false;
    runtime_.reset();
}

bool NodeCore::has_mount() const noexcept {
    const double level[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    double R_WS[9];
    return cb_sensor_rotation(runtime_.get(), level, R_WS) == CB_OK;
}

void NodeCore::start() noexcept {
    if (!runtime_) return;
    cb_reset(runtime_.get());
    contacts_.reset(), wrenches_.reset(), markers_.reset();
    counts_ = {}, samples_ = 0;
    last_reason_ = CB_NO_ANSWER, last_accepted_ = 0;
    active_ = true;
}

Answer NodeCore::farewell() const noexcept {
    Answer answer;
    cb_contact& contact = answer.contact;
    cb_check(runtime_.get(), 0.0, &contact);  // NaN wherever there is nothing
    contact.reason = CB_STALE, contact.accepted = 0, contact.health = 0;
    answer.health[0] = "inactive", answer.health_count = 1;
    answer.publish_contact = answer.publish_markers = true;
    return answer;
}

bool NodeCore::known(std::string_view frame, const std::string& wanted, const char* of) noexcept {
    if (bare(frame) == bare(wanted)) return true;
    ++counts_.wrong_frames;
    print(frame_trouble_, "The frame_id of %s is '%.*s', but parameter %s is '%.100s': the message is not used.", of,
          int(std::min<std::size_t>(frame.size(), 100)), frame.data(),
          std::strcmp(of, "the pose") == 0 ? "world_frame" : "sensor_frame", wanted.c_str());
    return false;
}

Taken NodeCore::pose(std::string_view frame, double time, const double position[3], const double xyzw[4]) noexcept {
    if (!active_) return Taken::inactive;
    if (!known(frame, settings_.world_frame, "the pose")) return Taken::wrong_frame;
    if (!(time > 0.0)) return ++counts_.no_time, Taken::no_time;
    double R[9];
    if (!rotation_of(xyzw, R) || cb_pose(runtime_.get(), R, position, time) != CB_OK)
        return ++counts_.poses_refused, Taken::refused;
    return ++counts_.poses, Taken::used;
}

Taken NodeCore::wrench(std::string_view frame, double time, double arrival, const double reading[6],
                       Answer& answer) noexcept {
    if (!active_) return Taken::inactive;
    if (!known(frame, settings_.sensor_frame, "the wrench")) return Taken::wrong_frame;
    if (!(time > 0.0)) return ++counts_.no_time, Taken::no_time;
    cb_sample sample = CB_SAMPLE_INIT;
    std::copy(reading, reading + 6, sample.wrench);
    sample.time = time, sample.arrival = arrival;
    answer.contact = CB_CONTACT_INIT;
    cb_update_sample(runtime_.get(), &sample, &answer.contact);
    if (counts_.wrenches++ == 0) first_time_ = time;
    last_time_ = time, ++samples_;
    counts_.accepted += std::uint64_t(answer.contact.accepted);
    counts_.not_finite += answer.contact.reason == CB_NOT_FINITE;
    counts_.health |= answer.contact.health;
    counts_.no_pose += (answer.contact.health & CB_HEALTH_NO_POSE) != 0;
    describe(answer);
    return Taken::used;
}

bool NodeCore::silence(double now, Answer& answer) noexcept {
    if (!active_) return false;
    answer.contact = CB_CONTACT_INIT;
    cb_check(runtime_.get(), now, &answer.contact);
    if (answer.contact.reason == CB_NO_ANSWER) return false;
    describe(answer);
    answer.publish_contact = true;
    return true;
}

void NodeCore::describe(Answer& answer) noexcept {
    const cb_contact& contact = answer.contact;
    answer.health_count = 0;
    for (std::size_t bit = 0; bit < health_names.size(); ++bit)
        if (contact.health >> bit & 1u) answer.health[answer.health_count++] = health_names[bit];
    const bool changed = contact.reason != last_reason_ || contact.accepted != last_accepted_;
    last_reason_ = contact.reason, last_accepted_ = contact.accepted;
    answer.publish_contact = contacts_.due(contact.time) || changed;
    answer.publish_wrench = answer.has_wrench() && wrenches_.due(contact.time);
    answer.publish_markers = markers_.due(contact.time);
}

ZeroWords NodeCore::zero() const {
    static const std::string remedy =
        " Nothing was changed: the bundle holds this sensor's bias, so do not zero the sensor itself. If somebody did, "
        "calibrate, verify and export again.";
    if (!active_) return {false, "The node is not active, so it does not watch the zero: activate it." + remedy};
    cb_zero zero = CB_ZERO_INIT;
    cb_check_zero(runtime_.get(), &zero);
    const std::string shift = formatted("a contact at 10 N moves by up to %.2g ± %.1g mm", 1e3 * zero.shift,
                                        1e3 * zero.shift_sigma);
    switch (zero.state) {
        case CB_ZERO_CONFIRMED:
            return {true, formatted("The sensor's zero was confirmed %.1f s ago: off by ", zero.age) + sizes(zero) +
                              "; " + shift + "." + remedy};
        case CB_ZERO_DOUBTFUL:
            return {false, "The sensor reads " + sizes(zero) + " too much, or something touches the probe. If nothing "
                               "does, " + shift + ". Lift the probe clear and hold it still at three tilts, 20° apart." +
                               remedy};
        case CB_ZERO_OFF:
            return {false, "The sensor's zero is off by " + sizes(zero) + ": " + shift +
                               ". Recalibrate before you trust a contact." + remedy};
        default:
            return {false, "The sensor's zero is not known yet: hold the probe still for a second without touching "
                           "anything." + remedy};
    }
}

// The worst first. Null: all is well.
const char* NodeCore::trouble(double now, Level& level) noexcept {
    cb_zero zero = CB_ZERO_INIT;
    cb_check_zero(runtime_.get(), &zero);
    const double looked = last_time_ - first_time_;
    const double rate = counts_.wrenches > 1 && looked >= shortest_look ? double(counts_.wrenches - 1) / looked : NAN;
    cb_contact silent = CB_CONTACT_INIT;
    cb_check(runtime_.get(), now, &silent);
    level = Level::error;
    if (counts_.wrong_frames > 0) return frame_trouble_.data();
    if (counts_.no_time > 0)
        return "Messages have no time stamp, or a negative one: let their source stamp them when it measures. For a "
               "flange that nothing moves, set static_pose.";
    if (silent.health & CB_HEALTH_SILENT) {
        if (samples_ > 0 && last_time_ > now + info_.max_age_s)
            return "The time stamps of the wrenches are ahead of this node's clock: synchronize the clocks.";
        return "No wrench comes: check the sensor's driver and parameter wrench_topic.";
    }
    if (counts_.wrenches > 0 && counts_.no_pose == counts_.wrenches)
        return "No pose is young enough: check the pose source, and that poses and wrenches have one clock.";
    if (counts_.health & CB_HEALTH_FROZEN) return "The sensor hangs: its readings repeat beyond chance. Restart it.";
    if (counts_.wrenches > 0 && counts_.not_finite == counts_.wrenches)
        return "The wrenches are not numbers: check the sensor's driver.";
    if (zero.state == CB_ZERO_OFF)
        return "The sensor's zero is off: recalibrate before you trust a contact. The zero service says by how much.";
    level = Level::warn;
    if (std::fabs(rate - info_.rate_Hz) > largest_rate_error * info_.rate_Hz) {
        print(trouble_, "Wrenches come at %.0f Hz, but the bundle is for %.0f Hz: calibrate, verify and export at this "
                        "rate.", rate, info_.rate_Hz);
        return trouble_.data();
    }
    if (counts_.no_pose > 0) return "Some wrenches had no pose that is young enough.";
    if (counts_.not_finite > 0) return "Some wrenches are not numbers.";
    if (counts_.poses_refused > 0) return "Some poses are no rotation, or not later than the one before.";
    if (zero.state == CB_ZERO_DOUBTFUL) return "The sensor's zero is doubtful: the zero service says what to do.";
    if (!info_.verified) return "The bundle is not verified: for trials without a person only.";
    level = Level::ok;
    return nullptr;
}

Status NodeCore::status(double now) {
    Status status;
    if (!active_) return {Level::ok, "Not active.", {}};
    const char* said = trouble(now, status.level);
    status.message = said ? said : "Locating.";
    cb_zero zero = CB_ZERO_INIT;
    cb_check_zero(runtime_.get(), &zero);
    const double looked = last_time_ - first_time_;
    const auto count = [](std::uint64_t n) { return std::to_string(n); };
    status.values = {
        {"bundle", settings_.bundle},
        {"probe", info_.probe},
        {"sensor model", info_.sensor_model},
        {"sensor serial", info_.sensor_serial},
        {"verified", info_.verified ? "true" : "false"},
        {"poses are of", has_mount() ? "the flange" : "the sensor"},
        {"wrenches", count(counts_.wrenches)},
        {"wrench rate, Hz",
         counts_.wrenches > 1 && looked > 0.0 ? formatted("%.1f", double(counts_.wrenches - 1) / looked) : "unknown"},
        {"accepted contacts", count(counts_.accepted)},
        {"poses", count(counts_.poses)},
        {"poses refused", count(counts_.poses_refused)},
        {"wrenches without a pose", count(counts_.no_pose)},
        {"messages of another frame", count(counts_.wrong_frames)},
        {"messages without a time", count(counts_.no_time)},
        {"zero", zero_states[std::size_t(zero.state)]},
        {"zero age, s", std::isfinite(zero.age) ? formatted("%.1f", zero.age) : "unknown"},
    };
    counts_ = {};
    return status;
}

}  // namespace contactbench_ros
