// How old the sensor's zero is, and how far it is off: told from moments in which nothing touches the probe.
//
// A moment is half a second in which the wrench is steady and the tool hardly turns. Its offset is what bias and weight
// leave of the mean reading. An offset that what is known of the zero explains is one without touch: a touch comes
// suddenly, drift does not. Any other offset may be a touch, something that leans on the probe, or a new zero. Only a zero
// stays the same, to within the noise, however the tool is tilted: it is believed after three tilts that agree, without a
// return to the old zero in between.
//
// The estimate is a weighted mean of offsets. The errors of the calibration and of the orientation are the same in all of
// them, so averaging does not lessen them: the mean's dependence on them is carried along, and the uncertainty that
// follows is exact for whatever weights and orientations.
//
// While a touch is located, its wrench says nothing of the zero: an offset mostly moves the contact, and the one direction
// that is left, torque about the force, is shared with the twist of soft tissue.
//
// Contract
//   units   S frame, N, N*m, m, s. `w`: after bias and weight, before any filter.
//   alarm   one-sided: `off` only where the offset moves a contact by more than `ZeroSettings::shift`, or the force by half
//           of the least force that counts, by `sure` standard deviations. It ends below three quarters of that.
//   cost    no allocation, nothing throws; sums at a sample, some microseconds twice a second.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "gravity.hpp"

namespace contactbench {

struct ZeroSettings {
    double covariance[12][12] = {};              // of the calibration: weight in W, force bias, centre of mass, torque bias
    double orientation = 0.0017453292519943296;  // rad about each axis, one standard deviation: 0.1 degrees
    double force = 10.0, shift = 5e-4;           // a touch of so many N must not move by more, m
};

enum class ZeroState : std::int32_t {
    unknown,    // no moment without touch so far
    confirmed,  // it was right when it was last seen
    doubtful,   // off, unless something touches the probe
    off,
};

inline const char* zero_state_name(std::int32_t state) {
    static constexpr const char* names[] = {"unknown", "confirmed", "doubtful", "off"};
    return state >= 0 && state < 4 ? names[state] : "unknown";
}

// NaN for what is not known.
struct Zero {
    static constexpr double none = std::numeric_limits<double>::quiet_NaN();
    std::int32_t state = 0;
    std::int32_t follows = 0;  // Follows, of zero_follow.hpp: is it taken off?
    double age = none;  // s since the last moment without touch
    double offset[6] = {none, none, none, none, none, none};  // what the reading has too much
    double sigma[6] = {none, none, none, none, none, none};   // of `offset`, the calibration's share included
    double shift = none, shift_sigma = none;  // m: by how much that moves a contact, where it does so most
    // What is taken off the readings where the zero follows, its standard deviation, and s since it was last seen.
    double taken[6] = {none, none, none, none, none, none}, taken_sigma[6] = {none, none, none, none, none, none};
    double seen = none;
};

class ZeroWatch {
public:
    using Places = std::array<Vec3, 6>;  // where the probe is touched: the farthest points

    ZeroWatch(const GravityLoad& load, const ZeroSettings& settings, double min_force, const Places& places)
        : load_(load), settings_(settings), least_(0.5 * min_force), places_(places) {
        for (int i = 0; i < 12; ++i) std::copy_n(settings.covariance[i], 12, covariance_[i]);
        for (int i = orientation; i < parameters; ++i) covariance_[i][i] = settings.orientation * settings.orientation;
    }

    // The next sample. `touched`: a touch was located for it.
    void see(const Wrench& w, const double R_WS[9], double time, bool touched) noexcept {
        const double v[6] = {w.F.x, w.F.y, w.F.z, w.M.x, w.M.y, w.M.z};
        Window& s = window_;
        if (turned(R_WS)) {
            if (s.count[0] >= fewest) acquit();
            lose();
            ++stop_;
            std::copy_n(R_WS, 9, R_);
        }
        if (s.count[0] == 0) s.begin = time;
        else
            for (int i = 0; i < 6; ++i) s.rough[i] += (v[i] - s.last[i]) * (v[i] - s.last[i]);
        const int half = time - s.begin < 0.5 * window || s.count[0] < fewest ? 0 : 1;
        for (int i = 0; i < 6; ++i) s.sum[half][i] += v[i], s.last[i] = v[i];
        ++s.count[half];
        s.touched |= touched;
        if (half == 0 || time - s.begin < window || s.count[1] < fewest) return;
        acquit();
        Moment m;
        if (steady(m)) {
            describe(m, R_WS, time);
            judge(m);
        }
        lose();
    }

    // Samples are missing: those before and after are not of one moment.
    void lose() noexcept { window_ = Window(); }

    // Nothing is known of the zero.
    void reset() noexcept {
        lose();
        moments_ = suspects_ = 0;
        told_ = Zero();
    }

    Zero at(double now) const noexcept {
        Zero out = told_;
        if (moments_ > 0) out.age = std::max(0.0, now - mean_.time);
        return out;
    }

private:
    static constexpr int orientation = 12, parameters = 15;  // of the calibration, and the orientation's error
    using Matrix6 = double[6][6];
    using Errors = double[6][parameters];

    static constexpr double window = 0.5;        // s
    static constexpr std::int32_t fewest = 10;   // samples in half a window
    static constexpr double turning = 0.99985;   // cosine of 1 degree: beyond, it is another stop
    // What a zero does by itself, after a second; of one moment, what no filter of the sensor averages.
    static constexpr double walk[2] = {1e-3, 3e-5}, floor[2] = {0.01, 3e-4};  // N, N*m (and over the root of a second)
    static constexpr double unsteady[2] = {0.03, 1e-3};  // N, N*m from one half of a window to the other
    static constexpr double rough_sigmas = 4.0;  // of white noise, that the halves may differ by beside that
    static constexpr double sudden = 38.3;      // chi2 of 6: one moment in a million
    static constexpr double differing = 22.5;   // one in a thousand
    static constexpr double besides = 0.984807753012208, tilted = 0.9396926207859084;  // cosines of 10 and 20 degrees
    static constexpr int most_suspects = 8;
    // So many times less square change in S than in W, where that is at least the square of ten times `floor`.
    static constexpr double constancy = 4.0, least_change = 100.0;
    static constexpr double returned = 4.0;  // of the way back, all but one part in so many
    static constexpr double patience = 60.0;  // s without a moment that is free of touch
    // A vector of three components exceeds this many standard deviations in one case of 6000, and of one, in 300 000.
    static constexpr double sure = 4.5;
    static constexpr double cleared = 0.75;

    struct Window {
        std::int32_t count[2] = {};
        double begin = 0.0, last[6] = {}, sum[2][6] = {}, rough[6] = {};
        bool touched = false;
    };

    // Of one moment, or the mean of several.
    struct Offset {
        std::int64_t stop = 0;  // where it was seen last
        double time = 0.0, value[6] = {}, noise[6] = {};  // noise: variances
        Errors errors = {};  // how `value` changes with the parameters, but for the sign
    };

    struct Moment : Offset {
        Vec3 down;  // unit
        bool touched = false;
    };

    // `size`: over what is allowed, the largest; `surely`: the same, less what is not sure of it.
    struct Effect {
        double shift = 0.0, sigma = 0.0, size = 0.0, surely = -HUGE_VAL;
    };

    static int kind(int channel) noexcept { return channel < 3 ? 0 : 1; }

    // Away from where it stood?
    bool turned(const double R[9]) const noexcept {
        double trace = 0.0;
        for (int i = 0; i < 9; ++i) trace += R[i] * R_[i];
        return !(0.5 * (trace - 1.0) > turning);
    }

    // A wrench that goes back to where the zero was, be it only while the tool moves, was a touch.
    void acquit() noexcept {
        double back = 0.0, away = 0.0;
        for (int i = 0; i < 6; ++i) {
            const double mean = (window_.sum[0][i] + window_.sum[1][i]) / (window_.count[0] + window_.count[1]);
            const double zero = moments_ > 0 ? mean_.value[i] : 0.0, unit = floor[kind(i)];
            back += (mean - zero) * (mean - zero) / (unit * unit);
            away += (latest_.value[i] - zero) * (latest_.value[i] - zero) / (unit * unit);
        }
        if (returned * returned * back < away) suspects_ = 0;
    }

    // Mean and noise of the window; false where its halves differ. How much samples differ from the next tells white noise,
    // whatever the halves do.
    bool steady(Moment& m) const noexcept {
        const Window& s = window_;
        const double n0 = s.count[0], n1 = s.count[1], n = n0 + n1;
        for (int i = 0; i < 6; ++i) {
            const double white = s.rough[i] / (2.0 * (n - 1.0));
            const double step = s.sum[1][i] / n1 - s.sum[0][i] / n0;
            if (!(std::fabs(step) <= unsteady[kind(i)] + rough_sigmas * std::sqrt(white * (1.0 / n0 + 1.0 / n1)))) return false;
            m.value[i] = (s.sum[0][i] + s.sum[1][i]) / n;
            m.noise[i] = white / n + floor[kind(i)] * floor[kind(i)];
        }
        m.touched = s.touched;
        return true;
    }

    void describe(Moment& m, const double R[9], double time) const noexcept {
        const Vec3 weight = to_sensor(R, load_.gravity_W), c = load_.centre_of_mass_S;
        const double size = norm(weight);
        m.time = time, m.stop = stop_;
        m.down = size > 1e-3 ? (1.0 / size) * weight : to_sensor(R, {0.0, 0.0, -1.0});
        const Vec3 axis[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
        for (int k = 0; k < 3; ++k) {
            const Vec3 g = to_sensor(R, axis[k]), turn = cross(weight, axis[k]);
            put(m.errors, k, g, cross(c, g));
            put(m.errors, 3 + k, axis[k], {});
            put(m.errors, 6 + k, {}, cross(axis[k], weight));
            put(m.errors, 9 + k, {}, axis[k]);
            put(m.errors, orientation + k, turn, cross(c, turn));
        }
    }

    static void put(Errors& to, int column, Vec3 F, Vec3 M) noexcept {
        const double v[6] = {F.x, F.y, F.z, M.x, M.y, M.z};
        for (int i = 0; i < 6; ++i) to[i][column] = v[i];
    }

    static Offset as_calibrated(double time) noexcept {
        Offset none;
        none.time = time;
        return none;
    }

    void judge(const Moment& m) noexcept {
        if (moments_ == 0) mean_ = as_calibrated(m.time);
        if (apart2(mean_, m) > sudden) return suspect(m);
        suspects_ = 0;
        take(m);
        decide();
    }

    // Kalman's filter of a random walk; all six channels share one gain, so that the mean is one of whole moments.
    void take(const Moment& m) noexcept {
        const double passed = std::max(0.0, m.time - mean_.time);
        double known = 0.0, added = 0.0;
        for (int i = 0; i < 6; ++i) {
            mean_.noise[i] += walk[kind(i)] * walk[kind(i)] * passed;
            if (i < 3) known += mean_.noise[i], added += m.noise[i];
        }
        const double gain = moments_ > 0 ? known / (known + added) : 1.0;
        for (int i = 0; i < 6; ++i) {
            mean_.value[i] += gain * (m.value[i] - mean_.value[i]);
            for (int k = 0; k < parameters; ++k) mean_.errors[i][k] += gain * (m.errors[i][k] - mean_.errors[i][k]);
            mean_.noise[i] = (1.0 - gain) * (1.0 - gain) * mean_.noise[i] + gain * gain * m.noise[i];
        }
        mean_.time = m.time, mean_.stop = m.stop;
        moments_ = std::min(moments_ + 1, 1000000);
    }

    // Keeps it beside those before. With two that agree with it, all at other tilts, it is a new zero.
    void suspect(const Moment& m) noexcept {
        const Moment* agreed[2] = {};
        Moment* place = nullptr;  // for it: of one that it repeats, or else of the oldest
        for (int i = 0; i < suspects_; ++i) {
            Moment& s = suspected_[i];
            if (apart2(s, m) > differing) continue;
            const auto beside = [&](const Moment& other) { return dot(s.down, other.down) < besides; };
            if (!beside(m)) place = &s;
            else if (!agreed[0]) agreed[0] = &s;
            else if (!agreed[1] && beside(*agreed[0])) agreed[1] = &s;
        }
        if (agreed[1] && std::min(dot(agreed[0]->down, m.down), dot(agreed[1]->down, m.down)) < tilted &&
            (apart2(as_calibrated(m.time), m) <= sudden || turns_with_the_tool(*agreed[0], *agreed[1], m))) {
            moments_ = 0, mean_ = Offset();
            for (const Moment* each : {agreed[0], agreed[1], &m}) take(*each);
            suspects_ = 0;
            return decide();
        }
        if (!place) {
            if (suspects_ < most_suspects) ++suspects_;
            else std::move(suspected_ + 1, suspected_ + most_suspects, suspected_);
            place = &suspected_[suspects_ - 1];
        }
        *place = latest_ = m;
        const bool seen_lately = moments_ > 0 && (m.touched || m.time - mean_.time <= patience);
        if (told_.state == std::int32_t(ZeroState::off)) return;
        if (!seen_lately && tell(m, ZeroState::doubtful).surely > 1.0) return;
        if (moments_ > 0) tell(mean_, ZeroState::confirmed);
        else told_ = Zero();
    }

    // Is it far more constant in S than in W, where a weight is, and a cable that pulls?
    static bool turns_with_the_tool(const Offset& a, const Offset& b, const Offset& m) noexcept {
        double in_S = 0.0, in_W = 0.0;
        for (const Offset* other : {&a, &b})
            for (int k = 0; k < 6; ++k) {
                const int part = 3 * kind(k), axis = k - part;
                const double S = m.value[k] - other->value[k];
                double W = 0.0;  // the columns of R_SW are how the force changes with the weight in W
                for (int i = 0; i < 3; ++i)
                    W += m.errors[i][axis] * m.value[part + i] - other->errors[i][axis] * other->value[part + i];
                const double unit = floor[kind(k)];
                in_S += S * S / (unit * unit), in_W += W * W / (unit * unit);
            }
        return constancy * in_S + least_change < in_W;
    }

    void decide() noexcept {
        const bool was_off = told_.state == std::int32_t(ZeroState::off);
        const Effect e = tell(mean_, ZeroState::confirmed);
        if (was_off ? e.size >= cleared : moments_ > 1 && e.surely > 1.0) told_.state = std::int32_t(ZeroState::off);
    }

    Effect tell(const Offset& offset, ZeroState state) noexcept {
        Matrix6 P;
        spread(offset.errors, offset.noise, P);
        const Effect e = effect_of(offset.value, P);
        told_.state = std::int32_t(state);
        std::copy_n(offset.value, 6, told_.offset);
        for (int i = 0; i < 6; ++i) told_.sigma[i] = std::sqrt(P[i][i]);
        told_.shift = e.shift, told_.shift_sigma = e.sigma;
        return e;
    }

    // How far two offsets are apart, in standard deviations squared: about 6 for those of one zero. The orientation errs
    // anew at every stop.
    double apart2(const Offset& a, const Offset& b) const noexcept {
        Errors errors;
        double left[6], noise[6];
        const bool elsewhere = a.stop != b.stop;
        for (int i = 0; i < 6; ++i) {
            for (int k = 0; k < parameters; ++k)
                errors[i][k] = a.errors[i][k] - (elsewhere && k >= orientation ? 0.0 : b.errors[i][k]);
            left[i] = a.value[i] - b.value[i];
            noise[i] = a.noise[i] + b.noise[i] + walk[kind(i)] * walk[kind(i)] * std::fabs(a.time - b.time);
        }
        Matrix6 L;  // Cholesky's factor
        spread(errors, noise, L);
        if (elsewhere)
            for (int i = 0; i < 6; ++i)
                for (int j = 0; j < 6; ++j)
                    for (int k = orientation; k < parameters; ++k) L[i][j] += covariance_[k][k] * b.errors[i][k] * b.errors[j][k];
        double sum = 0.0;
        for (int i = 0; i < 6; ++i) {
            for (int j = 0; j <= i; ++j) {
                for (int k = 0; k < j; ++k) L[i][j] -= L[i][k] * L[j][k];
                if (j < i) L[i][j] /= L[j][j], left[i] -= L[i][j] * left[j];
            }
            L[i][i] = std::sqrt(L[i][i]);
            left[i] /= L[i][i];
            sum += left[i] * left[i];
        }
        return sum;
    }

    // errors C errors^T + noise
    void spread(const Errors& errors, const double noise[6], Matrix6& P) const noexcept {
        for (int i = 0; i < 6; ++i) {
            double row[parameters] = {};
            for (int k = 0; k < parameters; ++k)
                for (int l = 0; l < parameters; ++l) row[l] += errors[i][k] * covariance_[k][l];
            for (int j = 0; j < 6; ++j) {
                P[i][j] = i == j ? noise[i] : 0.0;
                for (int l = 0; l < parameters; ++l) P[i][j] += row[l] * errors[j][l];
            }
        }
    }

    // A touch at p of force f moves by f x (M - p x F) / |f|^2, at most by the length of that torque over the force.
    Effect effect_of(const double offset[6], const Matrix6& P) const noexcept {
        const Vec3 F{offset[0], offset[1], offset[2]}, M{offset[3], offset[4], offset[5]};
        Effect out;
        const auto weigh = [&](Vec3 vector, Vec3 with_F, Vec3 with_M, double allowed) {
            const double a[6] = {with_F.x, with_F.y, with_F.z, with_M.x, with_M.y, with_M.z};
            double variance = 0.0;
            for (int i = 0; i < 6; ++i)
                for (int j = 0; j < 6; ++j) variance += a[i] * P[i][j] * a[j];
            const double size = norm(vector), sigma = std::sqrt(std::max(variance, 0.0));
            out.size = std::max(out.size, size / allowed);
            out.surely = std::max(out.surely, (size - sure * sigma) / allowed);
            return sigma;
        };
        for (const Vec3& p : places_) {
            const Vec3 torque = M - cross(p, F);
            const double size = norm(torque);
            if (!(size > 0.0)) continue;
            const Vec3 u = (1.0 / size) * torque;
            const double sigma = weigh(torque, cross(p, u), u, settings_.force * settings_.shift);
            if (size / settings_.force > out.shift) out.shift = size / settings_.force, out.sigma = sigma / settings_.force;
        }
        if (const double size = norm(F); size > 0.0 && least_ > 0.0) weigh(F, (1.0 / size) * F, {}, least_);
        return out;
    }

    GravityLoad load_;
    ZeroSettings settings_;
    double least_;  // N
    Places places_;
    double covariance_[parameters][parameters] = {};

    double R_[9] = {};  // of the stop
    std::int64_t stop_ = 0;
    Window window_;
    Offset mean_;
    int moments_ = 0;  // in it
    Moment suspected_[most_suspects];
    Moment latest_;  // of them
    int suspects_ = 0;
    Zero told_;  // but for the age
};

}  // namespace contactbench
