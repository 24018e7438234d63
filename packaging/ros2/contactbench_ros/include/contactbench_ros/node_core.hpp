// What the node decides, without ROS: which wrench and pose is used, what is published, and what diagnostics say.
//
// Contract
//   units      N, N*m, m, s; the sensor's frame S. Times are on one clock, that of the messages' stamps.
//   poses      of the flange in W, or of the sensor where the bundle holds no mount. A wrench takes the pose at its own
//              time, by the rule of `contactbench run` (docs/reference/run.md).
//   clock      a clock that was set back makes 50 readings, or those of max_age_s, stale; then the stream starts anew.
//   memory     `wrench`, `pose` and `silence` allocate nothing and throw nothing.
//   threads    one at a time.
#pragma once

#include <contactbench_runtime.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace contactbench_ros {

struct Settings {
    std::string bundle;               // a folder: unpack a zip first
    std::string sensor_frame;         // of the wrenches
    std::string world_frame;          // of the poses: W
    bool accept_unverified = false;
    bool self_test = true;            // replay the bundle's test vectors; one of version 2 or older has none
    double contact_rate = 0.0;        // Hz at most; 0: every sample. A change is published at once
    double wrench_rate = 0.0;
    double marker_rate = 30.0;
};

// What became of a message.
enum class Taken {
    used,
    inactive,     // the node is not active
    wrong_frame,  // frame_id is not the one that the settings name
    no_time,      // its stamp is 0, or before it: nobody knows when it was measured
    refused       // a pose: no rotation, not finite, or not later than the one before
};

struct Answer {
    cb_contact contact = CB_CONTACT_INIT;
    std::array<const char*, 6> health{};  // the first `health_count`: what is wrong
    std::size_t health_count = 0;
    bool publish_contact = false, publish_wrench = false, publish_markers = false;

    const char* reason() const noexcept { return cb_reason_name(contact.reason); }
    bool has_wrench() const noexcept;  // there is a compensated wrench
    bool has_point() const noexcept;
};

enum class Level : unsigned char { ok = 0, warn = 1, error = 2 };

struct Status {
    Level level = Level::ok;
    std::string message;
    std::vector<std::pair<std::string, std::string>> values;
};

// What is said of the sensor's zero; `trusted`: it was seen, and it is right.
struct ZeroWords {
    bool trusted = false;
    std::string message;
};

class NodeCore {
public:
    // Loads the bundle. False: `error` names what is wrong and the remedy.
    bool open(const Settings& settings, std::string& error);
    void close() noexcept;
    bool is_open() const noexcept { return runtime_ != nullptr; }
    // Whether poses have to be the flange's; else they are the sensor's own.
    bool has_mount() const noexcept;

    // The next sample and the next pose are first ones, whatever was before.
    void start() noexcept;
    void stop() noexcept { active_ = false; }
    // The last answer of a stream: there is no contact, and health says `inactive`.
    Answer farewell() const noexcept;
    bool is_active() const noexcept { return active_; }

    // `xyzw` need not be of unit length to the last bit.
    Taken pose(std::string_view frame, double time, const double position[3], const double xyzw[4]) noexcept;
    // A raw reading Fx Fy Fz Mx My Mz, measured at `time`, here at `arrival`. `answer` is filled in where it is used.
    Taken wrench(std::string_view frame, double time, double arrival, const double reading[6], Answer& answer) noexcept;
    // Whether no wrench comes; `answer` then says so. To be called ten times a second.
    bool silence(double now, Answer& answer) noexcept;

    // Changes nothing, here or in the sensor.
    ZeroWords zero() const;
    // Of the time since the last call.
    Status status(double now);

private:
    struct Close {
        void operator()(cb_runtime* runtime) const noexcept { cb_close(runtime); }
    };
    class Limiter {
    public:
        void set(double rate) noexcept { period_ = rate > 0.0 ? 1.0 / rate : 0.0; }
        void reset() noexcept { last_ = -std::numeric_limits<double>::infinity(); }
        bool due(double time) noexcept;

    private:
        double period_ = 0.0, last_ = -std::numeric_limits<double>::infinity();
    };
    struct Counts {
        std::uint64_t wrenches = 0, accepted = 0, poses = 0, poses_refused = 0, no_pose = 0, not_finite = 0;
        std::uint64_t wrong_frames = 0, no_time = 0, health = 0;
    };

    bool known(std::string_view frame, const std::string& wanted, const char* of) noexcept;
    void describe(Answer& answer) noexcept;
    const char* trouble(double now, Level& level) noexcept;

    std::unique_ptr<cb_runtime, Close> runtime_;
    Settings settings_;
    cb_info info_{};
    Limiter contacts_, wrenches_, markers_;
    Counts counts_;
    std::uint64_t samples_ = 0;  // since `start`
    double last_time_ = 0.0, first_time_ = 0.0;
    int last_reason_ = CB_NO_ANSWER;
    int last_accepted_ = 0;
    std::array<char, 512> frame_trouble_{}, trouble_{};
    bool active_ = false;
};

}  // namespace contactbench_ros
