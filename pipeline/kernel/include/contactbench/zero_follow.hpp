// Takes off what the sensor reads without a touch, learned in moments without touch.
//
// Of each channel, offset = slow + last: `slow` is a random walk from the calibrated zero (temperature), `last` is what a
// moment leaves to the next: cable, hysteresis, creep. It fades as the tool turns away and as time passes, towards a
// variance that is learned from the moments themselves: where the bench is good, that is nothing, and the moments are
// averaged; where it is bad, the last moment counts. A moment tells of that variance as much as its own is small, so the
// first one, before anything is known of `slow`, tells nearly nothing. One standard deviation is taken off the estimate:
// it cannot be negative, so chance alone would make it too large. A part linear in gravity was tried and did not do better.
//
// What leans on the probe must not become zero. A moment counts only if nothing is located in it, and its force only as
// far as `most` of the least force that counts from an anchor, its torque by the same share; what is beyond stays in the
// wrench and is added to the uncertainty. The anchor begins at the calibrated zero. It goes to `slow` only when a touch has
// just been let go, which nothing that leans on the probe does, and no faster than a sensor drifts. So less than half of
// the least force is ever taken off wrongly. Nor does a jump count while the tool stands and nothing was located in
// between. `stopped` says that moments were beyond that, or did not count.
//
// Contract: S frame, N, N*m, s. No allocation, nothing throws; sums at a sample, less than a microsecond ten times a second.
#pragma once

#include "zero.hpp"

namespace contactbench {

enum class Follows : std::int32_t { off, waiting, following, stopped };

inline const char* follows_name(std::int32_t state) {
    static constexpr const char* names[] = {"off", "waiting", "following", "stopped"};
    return state >= 0 && state < 4 ? names[state] : "off";
}

class ZeroFollow {
public:
    ZeroFollow(bool on, double min_force) : on_(on), most_(most * min_force) { reset(); }

    bool on() const noexcept { return on_; }

    // Takes the offset off a compensated wrench and adds its uncertainty; tells whether that is another than before.
    bool apply(Wrench& w, WrenchCovariance& noise) noexcept {
        if (!on_) return false;
        w.F = w.F - Vec3{taken_[0], taken_[1], taken_[2]}, w.M = w.M - Vec3{taken_[3], taken_[4], taken_[5]};
        for (int i = 0; i < 6; ++i) noise.s[i][i] += variance_[i];
        return std::exchange(changed_, false);
    }

    const double* taken() const noexcept { return taken_; }

    // The next sample: compensated, with nothing taken off; `touched`: a touch was located for it.
    void see(const Wrench& w, const double R_WS[9], double time, bool touched) noexcept {
        if (!on_) return;
        if (!(cosine(R_WS, R_) > turning)) {
            lose();
            standing_ = false;
            std::copy_n(R_WS, 9, R_);
            look(time);
        }
        if (touched) {
            lose();
            standing_ = false;
            touched_ = time;
            return;
        }
        const double v[6] = {w.F.x, w.F.y, w.F.z, w.M.x, w.M.y, w.M.z};
        Half& h = halves_[1];
        if (h.count == 0) h.begin = time;
        else
            for (int i = 0; i < 6; ++i) h.rough[i] += (v[i] - h.last[i]) * (v[i] - h.last[i]);
        for (int i = 0; i < 6; ++i) h.sum[i] += v[i], h.last[i] = v[i];
        if (++h.count < fewest || time - h.begin < half) return;
        if (steady()) judge(time), lose();
        else halves_[0] = h, halves_[1] = Half();
        look(time);
    }

    // Samples are missing: those before and after are not of one moment.
    void lose() noexcept { halves_[0] = halves_[1] = Half(); }

    // Nothing is known of the zero but the calibration.
    void reset() noexcept {
        lose();
        moments_ = refused_ = 0;
        standing_ = false, changed_ = true;
        touched_ = -HUGE_VAL, anchored_ = HUGE_VAL;
        for (int k = 0; k < 2; ++k) learned_[k] = lasting[k] * lasting[k], known_[k] = 0.0;
        for (int i = 0; i < 6; ++i) {
            slow_[i] = last_[i] = taken_[i] = variance_[i] = R_[i] = anchor_[i % 3] = 0.0;
            ss_[i] = first[kind(i)] * first[kind(i)], sl_[i] = ll_[i] = beyond_[i] = 0.0;
        }
    }

    // Completes what is known of the zero.
    void tell(Zero& to, double now) const noexcept {
        if (!on_) return;
        to.follows = std::int32_t(moments_ == 0 && refused_ < few       ? Follows::waiting
                                  : refused_ < few ? Follows::following : Follows::stopped);
        if (moments_ == 0) return;
        to.seen = std::max(0.0, now - seen_);
        for (int i = 0; i < 6; ++i) to.taken[i] = taken_[i], to.taken_sigma[i] = std::sqrt(variance_[i]);
    }

private:
    static constexpr double half = 0.1;         // s, of a moment
    static constexpr std::int32_t fewest = 5;   // samples in it
    static constexpr double turning = 0.99985;  // cosine of 1 degree
    static constexpr double unlike = 0.8660254037844387;  // of 30 degrees: from here on `last` says nothing
    static constexpr double memory = 60.0;                // s
    // N, N*m: what a zero does by itself after a second, is off at first, and differs by from one moment to the next.
    static constexpr double walk[2] = {1e-4, 3e-6}, first[2] = {0.05, 2e-3}, lasting[2] = {0.01, 3e-4};
    static constexpr double floor[2] = {0.002, 6e-5};  // of one moment, what no filter of the sensor averages
    static constexpr double first_count = 4.0, most_count = 40.0;  // moments that the learned variance rests on
    static constexpr double most = 0.38;  // of the least force that counts
    static constexpr double drift[2] = {2e-3, 1e-4};  // N/s, N*m/s: no sensor that we know of drifts faster
    static constexpr double longest = 30.0, let_go = 0.5;  // s: of drift at a time; from a touch to a moment
    static constexpr double unsteady[2] = {0.03, 1e-3}, rough_sigmas = 4.0;  // as of ZeroWatch
    static constexpr std::int32_t few = 3;              // moments refused in a row

    struct Half {
        std::int32_t count = 0;
        double begin = 0.0, sum[6] = {}, last[6] = {}, rough[6] = {};
    };

    static int kind(int channel) noexcept { return channel < 3 ? 0 : 1; }

    static double cosine(const double a[9], const double b[9]) noexcept {
        double trace = 0.0;
        for (int i = 0; i < 9; ++i) trace += a[i] * b[i];
        return 0.5 * (trace - 1.0);
    }

    // The mean of two halves and its variance; false where they differ.
    bool steady() noexcept {
        const Half &a = halves_[0], &b = halves_[1];
        if (a.count == 0) return false;
        const double n = a.count + b.count;
        for (int i = 0; i < 6; ++i) {
            const double white = (a.rough[i] + b.rough[i]) / (2.0 * (n - 2.0));
            const double step = std::fabs(b.sum[i] / b.count - a.sum[i] / a.count);
            if (!(step <= unsteady[kind(i)] + rough_sigmas * std::sqrt(white * (1.0 / a.count + 1.0 / b.count)))) return false;
            value_[i] = (a.sum[i] + b.sum[i]) / n;
            noise_[i] = white / n + floor[kind(i)] * floor[kind(i)];
        }
        return true;
    }

    // How much of `last` there still is.
    double kept(double time) const noexcept {
        const double near = std::max(0.0, (cosine(R_, R_last_) - unlike) / (1.0 - unlike));
        return near * memory / (memory + std::max(0.0, time - time_));
    }

    void judge(double time) noexcept {
        double off2 = 0.0;
        bool jumped = false;
        for (int i = 0; i < 6; ++i) {
            if (i < 3) off2 += (value_[i] - anchor_[i]) * (value_[i] - anchor_[i]);
            const double step = std::fabs(value_[i] - stood_[i]) - unsteady[kind(i)] - drift[kind(i)] * (time - began_);
            jumped |= standing_ && step > rough_sigmas * std::sqrt(2.0 * noise_[i]);
        }
        const bool far = off2 > most_ * most_;
        refused_ = far || jumped ? std::min(refused_ + 1, few) : 0;
        if (jumped) return;
        if (!standing_ && !far) std::copy_n(value_, 6, stood_), began_ = time, standing_ = true;
        for (int i = 0; i < 6; ++i) {
            const double from = i < 3 ? anchor_[i] : 0.0;
            beyond_[i] = far ? (1.0 - most_ / std::sqrt(off2)) * (value_[i] - from) : 0.0;
            value_[i] -= beyond_[i];
            const double first_total = learned_[kind(i)] + noise_[i];
            if (moments_ == 0) known_[kind(i)] += first_count / (3.0 * first_total * first_total);
        }
        if (moments_ == 0) anchored_ = time;
        const double passed = moments_ > 0 ? std::max(0.0, time - time_) : 0.0, rho = moments_ > 0 ? kept(time) : 0.0;
        const double anew = 1.0 - rho * rho, lasts[2] = {surely(0), surely(1)};
        double gap[3], gap2 = 0.0, weights[2] = {}, pulls[2] = {};
        for (int i = 0; i < 6; ++i) {
            const double v = lasts[kind(i)];
            ss_[i] += walk[kind(i)] * walk[kind(i)] * passed;
            last_[i] *= rho, sl_[i] *= rho, ll_[i] = rho * rho * ll_[i] + anew * v;
            const double known = ss_[i] + 2.0 * sl_[i] + ll_[i], total = known + noise_[i];
            const double innovation = value_[i] - slow_[i] - last_[i];
            const double weight = anew / (total * total);
            weights[kind(i)] += anew * weight;
            pulls[kind(i)] += weight * (innovation * innovation - total + anew * (v - learned_[kind(i)]));
            const double s = ss_[i] + sl_[i], l = sl_[i] + ll_[i];
            slow_[i] += s / total * innovation, last_[i] += l / total * innovation;
            ss_[i] -= s * s / total, sl_[i] -= s * l / total, ll_[i] -= l * l / total;
            if (i < 3) gap[i] = slow_[i] - anchor_[i], gap2 += gap[i] * gap[i];
        }
        for (int k = 0; k < 2; ++k) {
            known_[k] += weights[k] - anew / most_count * known_[k];
            learned_[k] += pulls[k] / known_[k];
        }
        if (!far && time - touched_ < let_go) {
            const double way = drift[0] * std::min(time - anchored_, longest), size = std::sqrt(gap2);
            for (int i = 0; i < 3; ++i) anchor_[i] += size > way ? way / size * gap[i] : gap[i];
            anchored_ = time;
        }
        if (!far || moments_ == 0) seen_ = time;
        time_ = time;
        std::copy_n(R_, 9, R_last_);
        ++moments_;
    }

    // The variance of `last`, less one standard deviation of the estimate.
    double surely(int kind) const noexcept { return std::max(learned_[kind] - std::sqrt(2.0 / known_[kind]), 0.0); }

    // What is taken off from now on.
    void look(double time) noexcept {
        if (moments_ == 0) return;
        const double rho = kept(time), passed = std::max(0.0, time - time_);
        double gap2 = 0.0;
        for (int i = 0; i < 6; ++i) {
            taken_[i] = slow_[i] + rho * last_[i];
            if (i < 3) gap2 += (taken_[i] - anchor_[i]) * (taken_[i] - anchor_[i]);
            variance_[i] = ss_[i] + walk[kind(i)] * walk[kind(i)] * passed + 2.0 * rho * sl_[i] + rho * rho * ll_[i] +
                           (1.0 - rho * rho) * std::max(learned_[kind(i)], 0.0) + beyond_[i] * beyond_[i];
        }
        if (const double size = std::sqrt(gap2); size > most_)
            for (int i = 0; i < 3; ++i) taken_[i] = anchor_[i] + most_ / size * (taken_[i] - anchor_[i]);
        changed_ = true;
    }

    bool on_;
    double most_;  // N
    Half halves_[2];
    double value_[6] = {}, noise_[6] = {};  // of a moment
    double R_[9] = {}, R_last_[9] = {};     // where the tool stands, and stood in the last moment
    double time_ = 0.0, seen_ = 0.0, stood_[6] = {}, began_ = 0.0, anchor_[3], touched_, anchored_;
    double slow_[6], last_[6], ss_[6], sl_[6], ll_[6];  // and the covariance of the two
    double learned_[2], known_[2];                      // the variance of `last`, of forces and of torques; over its own
    double taken_[6], variance_[6], beyond_[6];
    std::int64_t moments_;
    std::int32_t refused_;
    bool standing_, changed_;
};

}  // namespace contactbench
