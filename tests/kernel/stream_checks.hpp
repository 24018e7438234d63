// Poses at any time, frozen readings, inertia.
#pragma once

#include <algorithm>
#include <memory>

#include "check.hpp"
#include "contactbench/health.hpp"
#include "contactbench/motion.hpp"
#include "contactbench/pose_track.hpp"

namespace testing {

using namespace contactbench;

// A tool that turns at a steady rate and is swung about.
inline Pose swung(double t, Vec3 rate, double amplitude = 0.1, double hertz = 1.0) {
    Pose pose;
    pose.time = t;
    detail::rotation_of(t * rate, pose.R);
    const double w = 2.0 * M_PI * hertz;
    pose.p[0] = amplitude * std::sin(w * t), pose.p[1] = 0.3 * t, pose.p[2] = -0.2;
    return pose;
}

inline double turned_off(const Pose& a, const Pose& b) { return norm(detail::turn_between(a, b)); }

inline void check_pose_track() {
    const PosePolicy policy;
    const Vec3 rate{0.2, -0.25, 0.1};
    auto track = std::make_unique<PoseTrack>();
    Pose found;
    double age = 0.0;
    CHECK(!track->at(0.0, policy, found, age));
    CHECK(track->add(swung(0.0, rate), policy));
    CHECK(track->at(0.1, policy, found, age) && turned_off(found, swung(0.0, rate)) == 0.0);  // held
    for (int i = 1; i <= 20; ++i) CHECK(track->add(swung(0.1 * i, rate), policy));
    CHECK(!track->add(swung(2.0, rate), policy));
    CHECK(!track->add(swung(1.9, rate), policy));
    for (double t = 0.003; t < 2.0; t += 0.0171) {
        CHECK(track->at(t, policy, found, age));
        CHECK(turned_off(found, swung(t, rate)) < 1e-12);
        CHECK(close(found.p[1], 0.3 * t, 1e-12) && found.time == t);
        CHECK(age >= 0.0 && age < 0.1 + 1e-12);
    }
    CHECK(!track->at(-1e-9, policy, found, age));
    CHECK(track->at(2.149, policy, found, age) && close(age, 0.149, 1e-9));
    CHECK(turned_off(found, swung(2.149, rate)) < 1e-12);
    CHECK(!track->at(2.151, policy, found, age));
    // In a gap that is too long: carried on, then nothing, then interpolated again.
    CHECK(track->add(swung(3.0, rate), policy) && track->add(swung(3.1, rate), policy));
    CHECK(track->at(2.1, policy, found, age) && turned_off(found, swung(2.1, rate)) < 1e-12);
    CHECK(!track->at(2.5, policy, found, age));
    CHECK(track->at(3.05, policy, found, age) && turned_off(found, swung(3.05, rate)) < 1e-12);
    // A clock that was set back begins anew; no rotation from nothing.
    CHECK(track->add(swung(0.5, rate), policy) && track->count() == 1);
    Pose bad = swung(0.6, rate);
    bad.R[4] = NAN;
    CHECK(!track->add(bad, policy));
    bad = swung(0.6, rate), bad.time = HUGE_VAL;
    CHECK(!track->add(bad, policy));
    // Poses that lie half a turn apart are no twist to go on with.
    track->clear();
    CHECK(track->add(swung(0.0, {}), policy) && track->add(swung(0.1, {0, 0, 31.0}), policy));
    CHECK(track->at(0.1, policy, found, age) && !track->at(0.11, policy, found, age));
    // Only the newest are kept; those before are forgotten, not mistaken.
    track->clear();
    for (int i = 0; i < 2000; ++i) CHECK(track->add(swung(0.002 * i, rate), policy));
    CHECK(track->count() == 512 && !track->at(2.9, policy, found, age));
    CHECK(track->at(3.5, policy, found, age) && turned_off(found, swung(3.5, rate)) < 1e-12);
    // A noisy twist is taken over 40 ms: two poses 2 ms apart would multiply their noise by 50.
    Random random(7);
    track->clear();
    double worst = 0.0;
    for (int i = 0; i < 400; ++i) {
        Pose noisy = swung(0.002 * i, {});
        detail::rotation_of({2e-4 * random.normal(), 0, 0}, noisy.R);
        CHECK(track->add(noisy, policy));
        if (i > 50 && track->at(0.002 * i + 0.02, policy, found, age)) worst = std::max(worst, turned_off(found, swung(0, {})));
    }
    CHECK(worst < 2e-3);
}

inline void check_frozen() {
    Random random(3);
    constexpr double chance = 1e-10;
    // Coarse: how often healthy readings repeat goes from never to nearly always.
    for (const double step : {1e-5, 0.02, 0.2, 0.4, 0.5}) {
        FrozenDetector detector;
        double w[6];
        long alarms = 0;
        for (int i = 0; i < 360000; ++i) {
            for (double& x : w) x = step * std::round(0.1 * random.normal() / step);
            alarms += detector.see(w, chance);
        }
        CHECK(alarms == 0);
        int until = 0;
        while (!detector.see(w, chance) && until < 100000) ++until;
        if (step <= 0.02) CHECK(until <= 12);
        if (step <= 0.2) CHECK(until <= 40);
        CHECK(until < 100000);
        for (double& x : w) x += step;
        CHECK(!detector.see(w, chance));  // it lives again
    }
    // One hang does not hide the next.
    for (const int first : {100, 0}) {
        FrozenDetector detector;
        double w[6];
        const auto lives = [&](int count) {
            for (int i = 0; i < count; ++i) {
                for (double& x : w) x = random.normal();
                detector.see(w, chance);
            }
        };
        const auto hangs = [&](int count) {
            int missed = 0;
            for (double& x : w) x = random.normal();
            for (int i = 0; i < count; ++i) missed += !detector.see(w, chance);
            return missed;
        };
        hangs(first);
        lives(2000);
        if (first == 0)
            for (const int length : {4, 12, 28, 60}) hangs(length + 1), lives(200);
        CHECK(hangs(200) < 40);
    }
    // From the first sample on.
    FrozenDetector detector;
    const double w[6] = {1, 2, 3, 4, 5, 6};
    int until = 0;
    while (!detector.see(w, chance)) ++until;
    CHECK(until > 100 && until < 300);  // nothing is known of it yet
    const double none[6] = {NAN, NAN, NAN, NAN, NAN, NAN};
    for (int i = 0; i < 1000; ++i) CHECK(!detector.see(none, chance));
}

inline void check_motion() {
    const PosePolicy policy;
    Random random(5);
    auto track = std::make_unique<PoseTrack>();
    MotionFit fit;
    Motion motion;
    fit.see(*track, policy, 0.15, HUGE_VAL);
    CHECK(!fit.at(0.0, policy, motion));
    const double w = 2.0 * M_PI, amplitude = 1.0 / (w * w);  // 1 m/s^2
    double worst = 0.0, square = 0.0, count = 0.0;
    for (int i = 0; i < 1250; ++i) {
        const double t = 0.008 * i;
        Pose pose = swung(t, {0.2, -0.25, 0.1}, amplitude);
        for (double& x : pose.p) x += 2e-5 * random.normal();
        track->add(pose, policy);
        fit.see(*track, policy, 0.15, HUGE_VAL);
        if (i < 30) continue;
        CHECK(fit.at(t + 0.004, policy, motion));
        const double off = motion.acceleration.x + std::sin(w * (t + 0.004));
        worst = std::max(worst, std::fabs(off) / motion.sigma);
        square += off * off, count += 1.0;
        CHECK(norm(motion.spin - Vec3{0.2, -0.25, 0.1}) < 1e-6 && norm(motion.spin_rate) < 1e-4);
    }
    CHECK(std::sqrt(square / count) < 0.1);  // of 1 m/s^2 in the amplitude
    CHECK(worst < 6.0);
    // Standing still, the poses' noise moves nothing.
    track->clear();
    double moved = 0.0;
    count = 0.0;
    for (int i = 0; i < 1250; ++i) {
        Pose pose = swung(0.008 * i, {}, 0.0);
        pose.p[1] = 0.0;
        for (double& x : pose.p) x += 2e-5 * random.normal();
        track->add(pose, policy);
        fit.see(*track, policy, 0.15, HUGE_VAL);
        if (i > 30 && fit.at(pose.time, policy, motion)) moved += norm(motion.acceleration) > 0.0, count += 1.0;
    }
    CHECK(moved / count < 0.1);
    // A sample that comes late is asked for with the poses around it.
    track->clear();
    for (int i = 0; i < 250; ++i) track->add(swung(0.008 * i, {}, amplitude), policy);
    for (double t = 0.5; t < 1.5; t += 0.013) {
        fit.see(*track, policy, 0.15, t + 0.075);
        CHECK(fit.at(t, policy, motion) && std::fabs(motion.acceleration.x + std::sin(w * t)) < 0.02);
    }
    // Poses that come too slowly for a cubic tell how hard it is accelerated, and nothing to take off.
    for (const double period : {0.03, 0.1, 0.2}) {
        track->clear();
        double least = HUGE_VAL;
        for (int i = 0; i < 60; ++i) {
            track->add(swung(period * i, {}, amplitude), policy);
            fit.see(*track, policy, 0.15, HUGE_VAL);
            if (period * i < 0.5) continue;
            CHECK(fit.at(period * i, policy, motion) && norm(motion.acceleration) == 0.0);
            least = std::min(least, motion.sigma - 0.3 * std::fabs(std::sin(w * period * i)));
        }
        CHECK(least > 0.0);
    }
    // Positions that no robot can have taken are none.
    track->clear();
    for (int i = 0; i < 60; ++i) {
        Pose pose = swung(0.008 * i, {});
        for (double& x : pose.p) x = 1e6 * random.normal();
        track->add(pose, policy);
        fit.see(*track, policy, 0.15, HUGE_VAL);
        CHECK(!fit.at(pose.time, policy, motion));
    }
    // Without positions there is no motion to speak of.
    track->clear();
    for (int i = 0; i < 100; ++i) {
        Pose pose = swung(0.008 * i, {});
        pose.p[0] = NAN;
        track->add(pose, policy);
    }
    fit.see(*track, policy, 0.15, HUGE_VAL);
    CHECK(!fit.at(0.8, policy, motion));
}

inline void check_streams() {
    check_pose_track();
    check_frozen();
    check_motion();
}

}  // namespace testing
