// What a controller runs at every sample: compensate, filter, gate, locate, say how sure that is.
//
// Contract
//   units      S frame, N, N*m, m, s. R_WS turns S into W (v_W = R_WS v_S), row major.
//   update     one stream, not thread-safe. noexcept, and no allocation after construction.
//   clock      a time far ahead makes those after it stale: when stale times have increased for more than
//              `gates.max_age`, or 50 samples, without one that is not, the stream starts anew, as after reset.
//   order      not_finite, stale and not_a_rotation leave everything as it was. Saturation is judged on the
//              raw reading; a saturated sample is a lost one: the filters hold. Every other gate and the
//              location take the compensated and filtered wrench.
//   gaps       a sample more than `gates.max_age` after the last one starts anew, as after reset.
//   location   filtered over accepted contacts only; held while contact is lost for at most
//              `gates.recent_samples` samples, and started anew after that.
#pragma once

#include "runtime_filters.hpp"
#include "solver.hpp"

namespace contactbench {

// A still sensor reads F = R_SW g + F0, M = L x (R_SW g) + M0.
struct GravityLoad {
    Vec3 gravity_W, force_bias, centre_of_mass_S, torque_bias;  // N, N, m, N*m
};

struct RuntimeSettings {
    GravityLoad gravity;
    WrenchCovariance noise;  // all of it: sensor after its filter, calibration, model error
    double torsion_arm = 1e-3;  // m
    Gates gates;
    bool filter_wrench = false;
    KalmanSettings kalman;
    std::vector<Section> sections;  // of the location's low-pass; none: not filtered
};

inline const char* reason_name(std::int32_t reason) {
    static constexpr const char* names[] = {"ok",          "vertex",         "ambiguous", "low_force",
                                            "tangential",  "off_surface",    "outside_region", "saturated",
                                            "stale",       "not_finite",     "not_a_rotation", "by_region",
                                            "implausible", "two_touches"};
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
    double confidence = 0.0;             // 0 to 1
    double runner_up[3] = {detail::unknown, detail::unknown, detail::unknown};  // the likeliest other place
    double second[3] = {detail::unknown, detail::unknown, detail::unknown};     // a touch that joined this one
};
static_assert(sizeof(RuntimeContact) == 6 * 4 + 36 * 8);

// Each column and row of unit length and at right angles to within 1e-3, and not a mirror.
inline bool is_rotation(const double R[9]) {
    const Vec3 x{R[0], R[1], R[2]}, y{R[3], R[4], R[5]}, z{R[6], R[7], R[8]};
    const double off = std::max({std::fabs(dot(x, x) - 1), std::fabs(dot(y, y) - 1), std::fabs(dot(z, z) - 1),
                                 std::fabs(dot(x, y)), std::fabs(dot(y, z)), std::fabs(dot(z, x))});
    return off <= 1e-3 && dot(cross(x, y), z) > 0.0;
}

// What the tissue does to the probe: the reading without bias and weight.
inline Wrench compensate(const GravityLoad& load, const double wrench[6], const double R_WS[9]) {
    const Vec3 g = load.gravity_W;
    const Vec3 weight_S{g.x * R_WS[0] + g.y * R_WS[3] + g.z * R_WS[6],
                        g.x * R_WS[1] + g.y * R_WS[4] + g.z * R_WS[7],
                        g.x * R_WS[2] + g.y * R_WS[5] + g.z * R_WS[8]};
    const Vec3 F{wrench[0], wrench[1], wrench[2]}, M{wrench[3], wrench[4], wrench[5]};
    return {F - (weight_S + load.force_bias), M - (cross(load.centre_of_mass_S, weight_S) + load.torque_bias)};
}

class Runtime {
public:
    Runtime(std::shared_ptr<const Model> model, const RuntimeSettings& settings)
        : gravity_(settings.gravity), gates_(settings.gates), filter_wrench_(settings.filter_wrench),
          kalman_(settings.kalman), low_pass_(settings.sections),
          solver_(model, settings.noise, settings.torsion_arm, unsaturated(settings.gates)) {}

    RuntimeContact update(const double wrench[6], const double R_WS[9], double time) noexcept {
        RuntimeContact out;
        out.time = time;
        out.reason = refusal(wrench, R_WS, time);
        if (out.reason == std::int32_t(Reason::stale) && clock_went_back(time)) {
            reset();
            out.reason = refusal(wrench, R_WS, time);
        }
        if (out.reason != std::int32_t(Reason::ok)) return out;
        if (running_ && time - last_time_ > gates_.max_age) reset();
        const double dt = running_ ? time - last_time_ : 0.0;
        running_ = true;
        last_time_ = time;
        stale_ = 0;
        const Wrench raw{{wrench[0], wrench[1], wrench[2]}, {wrench[3], wrench[4], wrench[5]}};
        const bool saturated = gate(raw, gates_) == Reason::saturated;
        const bool known = saturated ? skip(dt) : filter(compensate(gravity_, wrench, R_WS), dt);
        if (known) put(out.wrench, filtered_.F), put(out.wrench + 3, filtered_.M);
        // An age of NaN is never recent enough: the solver counts a miss.
        solver_.track(filtered_, saturated ? detail::unknown : 0.0, answer_);
        out.reason = std::int32_t(saturated ? Reason::saturated : answer_.reason);
        describe(out);
        follow_point(out);
        return out;
    }

    // Forget the stream: the next sample is a first one, whatever its time.
    void reset() noexcept {
        kalman_.reset();
        low_pass_.reset();
        solver_.reset();
        running_ = holding_ = has_wrench_ = false;
        stale_ = 0;
        filtered_ = {};
    }

    const Model& model() const noexcept { return solver_.model(); }

private:
    static Gates unsaturated(Gates g) {
        for (double& limit : g.saturation) limit = HUGE_VAL;
        return g;
    }

    static void put(double* to, Vec3 v) noexcept { to[0] = v.x, to[1] = v.y, to[2] = v.z; }

    // Given a stale time: whether they have gone on for so long that the last one taken must have been the wrong one.
    bool clock_went_back(double time) noexcept {
        if (stale_ == 0 || !(time > stale_last_)) stale_ = 0, stale_first_ = time;
        stale_last_ = time;
        return ++stale_ > most_stale || time - stale_first_ > gates_.max_age;
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
        if (filter_wrench_) {
            const double sample[6] = {w.F.x, w.F.y, w.F.z, w.M.x, w.M.y, w.M.z};
            kalman_.update(sample, dt);
            const double* s = kalman_.state();
            filtered_ = {{s[0], s[1], s[2]}, {s[3], s[4], s[5]}};
        }
        return has_wrench_ = true;
    }

    bool skip(double dt) noexcept {
        if (filter_wrench_ && kalman_.started()) kalman_.skip(dt);
        return has_wrench_;
    }

    void describe(RuntimeContact& out) const noexcept {
        out.candidates = answer_.count;
        out.misfit = answer_.misfit, out.left_over = answer_.left_over, out.arm = answer_.arm;
        out.confidence = answer_.confidence;
        out.accepted = accepted(Reason(out.reason), gates_);
        const Candidate* c = answer_.contact();
        if (!c) return;
        put(out.point, c->point);
        put(out.normal, c->normal);
        out.torque_about_normal = c->torque;
        out.face = c->face, out.vertex = c->vertex, out.region = c->region;
        const Mat3 s = solver_.covariance(filtered_, c->point, c->normal, c->face);
        std::copy(&s.m[0][0], &s.m[0][0] + 9, out.covariance);
        if (const Candidate* other = runner_up(answer_)) put(out.runner_up, other->point);
        if (answer_.has_second) put(out.second, answer_.second.point);
    }

    void follow_point(RuntimeContact& out) noexcept {
        if (out.accepted) {
            const Vec3 point{out.point[0], out.point[1], out.point[2]};
            held_ = low_pass_.update(point);
            holding_ = true;
        } else if (!solver_.previous()) {
            low_pass_.reset();
            holding_ = false;
        }
        if (holding_) put(out.filtered_point, held_);
    }

    GravityLoad gravity_;
    Gates gates_;
    bool filter_wrench_;
    WrenchKalman kalman_;
    PointLowPass low_pass_;
    Solver solver_;
    Answer answer_;
    Wrench filtered_;
    Vec3 held_;
    static constexpr int most_stale = 50;
    double last_time_ = 0.0, stale_first_ = 0.0, stale_last_ = 0.0;
    int stale_ = 0;  // times in a row that increased, but not beyond last_time_
    bool running_ = false, holding_ = false, has_wrench_ = false;
};

}  // namespace contactbench
