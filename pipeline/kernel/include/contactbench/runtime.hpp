// What a controller runs at every sample: compensate, filter, gate, locate, say how sure that is.
//
// Contract
//   units      S frame, N, N*m, m, s. R_WS turns S into W (v_W = R_WS v_S), row major.
//   update     one stream, not thread-safe. noexcept, and no allocation after construction.
//   pose       poses come beside the samples, each with its time; a sample takes the one at its own time (see
//              pose_track.hpp), or comes with an orientation that the caller answers for.
//   health     a word beside the reason; what is unhealthy is never accepted. A frozen sample, and one whose time is a
//              guess, are lost ones: the filters hold.
//   motion     where poses have positions, what the tool's inertia does is taken off, and its uncertainty is added.
//   clock      a time far ahead makes those after it stale: when stale times have increased for more than
//              `gates.max_age`, or 50 samples, without one that is not, the stream starts anew, as after reset.
//   order      not_finite, stale and not_a_rotation leave everything as it was. Saturation is judged on the
//              raw reading; a saturated sample is a lost one: the filters hold. Every other gate and the
//              location take the compensated and filtered wrench; low_force, beside an adaptive filter, the
//              unfiltered one, too.
//   gaps       a sample more than `gates.max_age` after the last one starts anew, as after reset.
//   zero       watched beside all this, on the compensated readings before the filter; see zero.hpp. Where `follow` says
//              so, what is seen of it is taken off before the filter, with its covariance; see zero_follow.hpp.
//   location   filtered over accepted contacts only; held while contact is lost for at most `gates.recent_samples`
//              samples, or as many are uncertain, and started anew after that.
#pragma once

#include "health.hpp"
#include "motion.hpp"
#include "runtime_filters.hpp"
#include "solver.hpp"
#include "zero_follow.hpp"

namespace contactbench {

struct RuntimeSettings {
    GravityLoad gravity;
    WrenchCovariance noise;  // all of it: sensor after its filter, calibration, model error
    Torsion torsion;
    Gates gates;
    bool filter_wrench = false;
    KalmanSettings kalman;
    std::vector<Section> sections;  // of the location's low-pass; none: not filtered
    bool has_mount = false;         // poses are the flange's, R_WS = R_WE R_ES; else they are the sensor's own
    double R_ES[9] = {};
    PosePolicy poses;
    MotionSettings motion;
    double silence = 0.12;         // s without a sample
    double frozen_chance = 1e-10;  // of one run of repeats
    ZeroSettings zero;
    bool follow = false;  // the zero: what is seen of it is taken off
};

// A raw reading, and what is known of it.
struct RuntimeSample {
    double wrench[6];
    double time;  // when it was measured
    double arrival = std::numeric_limits<double>::quiet_NaN();  // when it came, on the same clock; NaN: not known
    std::uint32_t flags = 0;  // bits of Flag
};

inline const char* reason_name(std::int32_t reason) {
    static constexpr const char* names[] = {"ok",          "vertex",         "ambiguous", "low_force",
                                            "tangential",  "off_surface",    "outside_region", "saturated",
                                            "stale",       "not_finite",     "not_a_rotation", "by_region",
                                            "implausible", "two_touches",    "unhealthy",      "uncertain"};
    static_assert(sizeof names / sizeof *names == reason_count);
    return reason >= 0 && reason < reason_count ? names[reason] : "unknown";
}

namespace detail {
inline constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
}  // namespace detail

// NaN and -1 for what there is none of. Plain numbers without padding: two of them compare as bytes.
struct RuntimeContact {
    std::int32_t reason = std::int32_t(Reason::off_surface);
    std::int32_t face = -1, vertex = -1, region = 0;
    std::int32_t candidates = 0;
    std::int32_t accepted = 0;  // 1: a controller may use it
    std::uint32_t health = 0;   // bits of Health
    std::int32_t reserved = 0;
    double time = detail::unknown;
    double point[3] = {detail::unknown, detail::unknown, detail::unknown};
    double normal[3] = {detail::unknown, detail::unknown, detail::unknown};
    double torque_about_normal = detail::unknown;
    double wrench[6] = {detail::unknown, detail::unknown, detail::unknown,
                        detail::unknown, detail::unknown, detail::unknown};  // compensated, filtered
    double covariance[9] = {detail::unknown, detail::unknown, detail::unknown, detail::unknown, detail::unknown,
                            detail::unknown, detail::unknown, detail::unknown, detail::unknown};
    double filtered_point[3] = {detail::unknown, detail::unknown, detail::unknown};
    double misfit = detail::unknown;     // d2 of the best touch, in standard deviations squared
    double left_over = detail::unknown;  // N*m that it does not explain
    double arm = detail::unknown;        // m: M . F / |F|^2
    double confidence = 0.0;             // see Answer
    double runner_up[3] = {detail::unknown, detail::unknown, detail::unknown};  // the likeliest other place
    double second[3] = {detail::unknown, detail::unknown, detail::unknown};     // a touch that joined this one
    double pose_age = detail::unknown;  // s: how much older than the sample the last pose before it is
    double latency = detail::unknown;   // s: arrival less time, and how old the filter's wrench is by then
    double within = detail::unknown;    // m: how far the 95 % ellipse of the point reaches
    double torsion_arm = detail::unknown;    // m: what it was judged by; 1 sigma of torsion over force
    double torsion_since = detail::unknown;  // s: for how long that was learned; NaN: it is declared
    double raw[6] = {detail::unknown, detail::unknown, detail::unknown,
                     detail::unknown, detail::unknown, detail::unknown};  // as the sensor reads it
    double taken[6] = {};  // off the compensated wrench, because the zero follows
};
static_assert(sizeof(RuntimeContact) == 8 * 4 + 53 * 8);

// Each column and row of unit length and at right angles to within 1e-3, and not a mirror.
inline bool is_rotation(const double R[9]) {
    const Vec3 x{R[0], R[1], R[2]}, y{R[3], R[4], R[5]}, z{R[6], R[7], R[8]};
    const double off = std::max({std::fabs(dot(x, x) - 1), std::fabs(dot(y, y) - 1), std::fabs(dot(z, z) - 1),
                                 std::fabs(dot(x, y)), std::fabs(dot(y, z)), std::fabs(dot(z, x))});
    return off <= 1e-3 && dot(cross(x, y), z) > 0.0;
}

// Where the zero's offset moves a contact most: the farthest points, in S, of the facets that somebody has declared likely
// to be touched, or of all.
inline ZeroWatch::Places zero_places(const Model& m) {
    ZeroWatch::Places places;
    double far[6];
    std::fill_n(far, 6, -HUGE_VAL);
    const double least = m.most_bonus > 0.0 ? 0.0 : -HUGE_VAL;
    for (const std::int32_t face : m.tree.face) {
        if (face < 0 || !(m.bonus(face) > least)) continue;
        for (const std::int32_t v : m.faces[std::size_t(face)]) {
            const Vec3 p = m.vertices[std::size_t(v)];
            const double along[6] = {p.x, -p.x, p.y, -p.y, p.z, -p.z};
            for (std::size_t i = 0; i < 6; ++i)
                if (along[i] > far[i]) far[i] = along[i], places[i] = p;
        }
    }
    return places;
}

class Runtime {
public:
    Runtime(std::shared_ptr<const Model> model, const RuntimeSettings& settings)
        : settings_(settings), kalman_(settings.kalman), low_pass_(settings.sections),
          solver_(model, settings.noise, settings.torsion, unsaturated(settings.gates)),
          zero_(settings.gravity, settings.zero, settings.gates.min_force, zero_places(*model)),
          follow_(settings.follow, settings.gates.min_force) {}

    // The next pose, of the flange or of the sensor itself (`has_mount`). `p`: of its origin in W, m, or null. Returns
    // false for one that is not used.
    bool pose(const double R[9], const double* p, double time) noexcept {
        Pose next;
        next.time = time;
        if (settings_.has_mount) detail::times(R, settings_.R_ES, next.R);
        else std::copy(R, R + 9, next.R);
        if (p && std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2])) std::copy(p, p + 3, next.p);
        if (!is_rotation(next.R) || !track_.add(next, settings_.poses)) return false;
        if (settings_.motion.on) fit_.see(track_, settings_.poses, settings_.motion.window, HUGE_VAL);
        return true;
    }

    // The orientation of the sensor, R_WS, at a time, and how old the pose is that it rests on; false: it is not known.
    bool orientation(double time, double R_WS[9], double& age) const noexcept {
        Pose found;
        if (!track_.at(time, settings_.poses, found, age)) return false;
        std::copy(found.R, found.R + 9, R_WS);
        return true;
    }

    // With the orientation at its time.
    RuntimeContact update(const RuntimeSample& sample) noexcept {
        RuntimeContact out;
        double R_WS[9];
        if (!std::isfinite(sample.time) || orientation(sample.time, R_WS, out.pose_age)) {
            if (!std::isfinite(sample.time)) std::fill(R_WS, R_WS + 9, detail::unknown);
            take(sample, R_WS, out);
            return out;
        }
        // Nothing can be said of where it was touched, but much of the sensor.
        out.time = sample.time, out.latency = sample.arrival - sample.time;
        out.reason = std::int32_t(Reason::stale);
        out.health = health_of(sample) | Health::no_pose;
        return out;
    }

    // With an orientation from elsewhere.
    RuntimeContact update(const RuntimeSample& sample, const double R_WS[9]) noexcept {
        RuntimeContact out;
        take(sample, R_WS, out);
        return out;
    }

    RuntimeContact update(const double wrench[6], const double R_WS[9], double time) noexcept {
        RuntimeSample sample{};
        std::copy(wrench, wrench + 6, sample.wrench);
        sample.time = time;
        return update(sample, R_WS);
    }

    // Whether samples have stopped coming; `out` is then a contact of `now` that says so.
    bool silent(double now, RuntimeContact& out) const noexcept {
        if (std::fabs(now - heard_) <= settings_.silence) return false;
        out = RuntimeContact{};
        out.time = now;
        out.reason = std::int32_t(Reason::stale);
        out.health = Health::silent;
        return true;
    }

    // How old the zero is at the last sample, how far it is off, and what of that is taken off.
    Zero zero() const noexcept {
        Zero out = zero_.at(last_time_);
        follow_.tell(out, last_time_);
        return out;
    }

    // Forget the stream: the next sample is a first one, whatever its time.
    void reset() noexcept {
        begin_anew();
        heard_ = -HUGE_VAL;
        track_.clear();
        fit_.reset();
        frozen_.reset();
        zero_.reset();
        follow_.reset();
    }

    const Model& model() const noexcept { return solver_.model(); }

private:
    void begin_anew() noexcept {
        kalman_.reset();
        low_pass_.reset();
        solver_.reset();
        zero_.lose();
        follow_.lose();
        running_ = holding_ = has_wrench_ = false;
        stale_ = 0;
        filtered_ = {};
    }

    void take(const RuntimeSample& sample, const double R_WS[9], RuntimeContact& out) noexcept {
        const double time = sample.time;
        out.time = time, out.latency = sample.arrival - time;
        out.health = health_of(sample);
        double wrench[6];
        reading_of(sample, wrench);
        out.reason = refusal(wrench, R_WS, time);
        if (out.reason == std::int32_t(Reason::stale) && clock_went_back(time)) {
            begin_anew();
            out.reason = refusal(wrench, R_WS, time);
        }
        if (out.reason != std::int32_t(Reason::ok)) return;
        if (running_ && time - last_time_ > settings_.gates.max_age) begin_anew();
        const double dt = running_ ? time - last_time_ : 0.0;
        running_ = true;
        last_time_ = time;
        stale_ = 0;
        const Wrench raw{{wrench[0], wrench[1], wrench[2]}, {wrench[3], wrench[4], wrench[5]}};
        const bool saturated = gate(raw, settings_.gates) == Reason::saturated;
        const bool unhealthy = (out.health & (Health::frozen | Health::clock)) != 0;
        const bool lost = saturated || unhealthy;
        Wrench touch, untouched;
        WrenchCovariance noise = settings_.noise;
        bool unusual = false;
        if (!lost) untouched = touch = compensate(settings_.gravity, load_at(R_WS, time, noise, unusual), wrench, R_WS);
        const bool moved = !lost && follow_.apply(touch, noise);
        std::copy_n(sample.wrench, 6, out.raw), std::copy_n(follow_.taken(), 6, out.taken);
        const bool known = lost ? skip(dt) : filter(touch, dt);
        if (known) put(out.wrench, filtered_.F), put(out.wrench + 3, filtered_.M), out.latency += kalman_.age();
        if (!lost) {
            unusual |= kalman_.add_doubt(noise);
            if (unusual || unusual_ || moved) solver_.set_noise(noise);
            unusual_ = unusual;
        }
        // What is let go is felt at once, whatever the filter still says.
        const bool released = !lost && norm(touch.F) + kalman_.chance() < settings_.gates.min_force;
        // An age of NaN is never recent enough: the solver counts a miss.
        solver_.track(released ? Wrench{} : filtered_, lost ? detail::unknown : 0.0, dt, answer_);
        out.reason = std::int32_t(saturated ? Reason::saturated : unhealthy ? Reason::unhealthy : answer_.reason);
        describe(out);
        follow_point(out);
        if (lost) return zero_.lose(), follow_.lose();
        zero_.see(untouched, R_WS, time, answer_.contact() != nullptr);
        follow_.see(untouched, R_WS, time, answer_.contact() != nullptr);
    }

    std::uint32_t health_of(const RuntimeSample& sample) noexcept {
        heard_ = std::isfinite(sample.arrival) ? sample.arrival : sample.time;
        std::uint32_t health = 0;
        if (frozen_.see(sample.wrench, settings_.frozen_chance)) health |= Health::frozen;
        if (Flag::wrong(sample.flags)) health |= Health::flagged;
        if (sample.flags & Flag::clock_leapt) health |= Health::clock;
        return health;
    }

    // What the sensor itself calls no measurement is none; but at the end of its range it says so by its value.
    void reading_of(const RuntimeSample& sample, double wrench[6]) const noexcept {
        std::copy(sample.wrench, sample.wrench + 6, wrench);
        const std::uint32_t wrong = Flag::wrong(sample.flags);
        bool at_end = false;
        for (int i = 0; i < 6; ++i) at_end |= std::fabs(wrench[i]) >= settings_.gates.saturation[i];
        if (wrong != 0 && !(wrong == Flag::overrange && at_end)) std::fill(wrench, wrench + 6, detail::unknown);
    }

    bool motion_at(double time, Motion& out) const noexcept {
        if (!settings_.motion.on || track_.count() == 0) return false;
        const double half = 0.5 * settings_.motion.window;
        if (track_.newest().time - time <= half) return fit_.at(time, settings_.poses, out);
        MotionFit around;  // of a sample that comes late
        around.see(track_, settings_.poses, settings_.motion.window, time + half);
        return around.at(time, settings_.poses, out);
    }

    // The tool's weight in W, less what accelerating it takes; `noise` gets how well that is known.
    Vec3 load_at(const double R_WS[9], double time, WrenchCovariance& noise, bool& unusual) noexcept {
        const Vec3 weight = settings_.gravity.gravity_W;
        Motion motion;
        if (!motion_at(time, motion)) return weight;
        const double mass = norm(weight) / standard_gravity;
        const Vec3 c = settings_.gravity.centre_of_mass_S;
        const Vec3 r = detail::turned(R_WS, c);
        const Vec3 a = motion.acceleration + cross(motion.spin_rate, r) + cross(motion.spin, cross(motion.spin, r));
        // A bundle does not know how far the flange, which the position is of, is from the sensor.
        const double lever = flange_to_sensor * (norm(motion.spin_rate) + norm2(motion.spin));
        const double force2 = mass * mass * (motion.sigma * motion.sigma + lever * lever);
        const double turning = mass * settings_.motion.gyration * settings_.motion.gyration * norm(motion.spin_rate);
        const double X[3][3] = {{0, -c.z, c.y}, {c.z, 0, -c.x}, {-c.y, c.x, 0}};
        for (int i = 0; i < 3; ++i) {
            noise.s[i][i] += force2;
            noise.s[3 + i][3 + i] += turning * turning;
            for (int j = 0; j < 3; ++j) {
                noise.s[3 + i][j] += force2 * X[i][j], noise.s[j][3 + i] += force2 * X[i][j];
                for (int k = 0; k < 3; ++k) noise.s[3 + i][3 + j] += force2 * X[i][k] * X[j][k];
            }
        }
        unusual = true;
        return weight - mass * a;
    }

    static Gates unsaturated(Gates g) {
        for (double& limit : g.saturation) limit = HUGE_VAL;
        return g;
    }

    static void put(double* to, Vec3 v) noexcept { to[0] = v.x, to[1] = v.y, to[2] = v.z; }

    // Given a stale time: whether they have gone on for so long that the last one taken must have been the wrong one.
    bool clock_went_back(double time) noexcept {
        if (stale_ == 0 || !(time > stale_last_)) stale_ = 0, stale_first_ = time;
        stale_last_ = time;
        return ++stale_ > most_stale || time - stale_first_ > settings_.gates.max_age;
    }

    std::int32_t refusal(const double wrench[6], const double R_WS[9], double time) const noexcept {
        bool known = std::isfinite(time);
        for (int i = 0; i < 6; ++i) known &= std::isfinite(wrench[i]);
        for (int i = 0; i < 9; ++i) known &= std::isfinite(R_WS[i]);
        if (!known) return std::int32_t(Reason::not_finite);
        if (running_ && !(time > last_time_)) return std::int32_t(Reason::stale);
        return std::int32_t(is_rotation(R_WS) ? Reason::ok : Reason::not_a_rotation);
    }

    bool filter(const Wrench& w, double dt) noexcept {
        filtered_ = w;
        if (settings_.filter_wrench) {
            const double sample[6] = {w.F.x, w.F.y, w.F.z, w.M.x, w.M.y, w.M.z};
            kalman_.update(sample, dt);
            const double* s = kalman_.state();
            filtered_ = {{s[0], s[1], s[2]}, {s[3], s[4], s[5]}};
        }
        return has_wrench_ = true;
    }

    bool skip(double dt) noexcept {
        if (settings_.filter_wrench && kalman_.started()) kalman_.skip(dt);
        return has_wrench_;
    }

    void describe(RuntimeContact& out) const noexcept {
        out.candidates = answer_.count;
        out.misfit = answer_.misfit, out.left_over = answer_.left_over, out.arm = answer_.arm;
        out.confidence = answer_.confidence;
        out.torsion_arm = answer_.torsion_arm, out.torsion_since = answer_.torsion_since;
        out.accepted = out.health == 0 && accepted(Reason(out.reason), settings_.gates);
        const Candidate* c = answer_.contact();
        if (!c) return;
        put(out.point, c->point);
        put(out.normal, c->normal);
        out.torque_about_normal = c->torque;
        out.face = c->face, out.vertex = c->vertex, out.region = c->region;
        if (!answer_.has_second) {  // the force is that of both: it says little of where each one is
            const Mat3 s = solver_.covariance(filtered_, c->point, c->normal, c->face, c->depth, answer_.torsion_arm);
            std::copy(&s.m[0][0], &s.m[0][0] + 9, out.covariance);
            out.within = sigmas_of_95 * largest_sigma(s);
        }
        if (const Candidate* other = runner_up(answer_)) put(out.runner_up, other->point);
        if (answer_.has_second) put(out.second, answer_.second.point);
    }

    void follow_point(RuntimeContact& out) noexcept {
        if (out.accepted) {
            const Vec3 point{out.point[0], out.point[1], out.point[2]};
            held_ = low_pass_.update(point);
            holding_ = true;
            uncertain_ = 0;
        } else if (!solver_.previous() ||
                   (answer_.reason == Reason::uncertain && ++uncertain_ > settings_.gates.recent_samples)) {
            low_pass_.reset();
            holding_ = false;
        }
        if (holding_) put(out.filtered_point, held_);
    }

    static constexpr double flange_to_sensor = 0.05;  // m, roughly
    RuntimeSettings settings_;
    PoseTrack track_;
    MotionFit fit_;
    FrozenDetector frozen_;
    bool unusual_ = false;  // the solver's noise is not that of the settings
    WrenchKalman kalman_;
    PointLowPass low_pass_;
    Solver solver_;
    ZeroWatch zero_;
    ZeroFollow follow_;
    Answer answer_;
    Wrench filtered_;
    Vec3 held_;
    static constexpr int most_stale = 50;
    double last_time_ = 0.0, stale_first_ = 0.0, stale_last_ = 0.0;
    double heard_ = -HUGE_VAL;  // when the last sample came, whatever was wrong with it
    std::int64_t uncertain_ = 0;  // samples since the last accepted one; the contact is followed, but what is held grows old
    int stale_ = 0;  // times in a row that increased, but not beyond last_time_
    bool running_ = false, holding_ = false, has_wrench_ = false;
};

}  // namespace contactbench
