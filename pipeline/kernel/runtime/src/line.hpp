// A contact and the zero as the structs of the C boundary, and as the line of JSON that programs pass on.
#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <string_view>

#include "contactbench/runtime.hpp"
#include "contactbench_runtime.h"

namespace contactbench::runtime {

inline void copy(double* to, const double* from, int n) noexcept { std::copy(from, from + n, to); }

// Member by member: each of the two structs may grow on its own.
inline cb_contact to_c(const RuntimeContact& c, std::int32_t on) noexcept {
    cb_contact out = CB_CONTACT_INIT;
    out.reason = c.reason, out.accepted = c.accepted;
    out.face = c.face, out.vertex = c.vertex;
    out.region = c.region, out.candidates = c.candidates, out.health = c.health;
    out.time = c.time;
    copy(out.point, c.point, 3), copy(out.normal, c.normal, 3);
    out.torque_about_normal = c.torque_about_normal;
    copy(out.force, c.wrench, 3), copy(out.torque, c.wrench + 3, 3);
    copy(out.covariance, c.covariance, 9), copy(out.filtered_point, c.filtered_point, 3);
    out.misfit = c.misfit, out.left_over = c.left_over, out.arm = c.arm, out.confidence = c.confidence;
    copy(out.runner_up, c.runner_up, 3), copy(out.second, c.second, 3);
    out.pose_age = c.pose_age, out.latency = c.latency, out.within = c.within;
    out.torsion_arm = c.torsion_arm, out.torsion_since = c.torsion_since;
    copy(out.raw, c.raw, 6), copy(out.taken, c.taken, 6);
    out.on = on;
    return out;
}

inline cb_zero to_c(const Zero& zero) noexcept {
    cb_zero out = CB_ZERO_INIT;
    out.state = zero.state, out.age = zero.age;
    copy(out.force, zero.offset, 3), copy(out.torque, zero.offset + 3, 3);
    copy(out.force_sigma, zero.sigma, 3), copy(out.torque_sigma, zero.sigma + 3, 3);
    out.shift = zero.shift, out.shift_sigma = zero.shift_sigma;
    out.follows = zero.follows, out.seen = zero.seen;
    copy(out.taken, zero.taken, 6), copy(out.taken_sigma, zero.taken_sigma, 6);
    return out;
}

// Numbers are the fewest digits that read back as the same double. JSON knows no NaN: what there is none of is null, or
// left out, where a schema of plain types has to hold. The longest line has some 2,400 characters.
class Line {
public:
    Line(const cb_contact& c, const cb_zero& zero, bool nulls = true) noexcept : nulls_(nulls) {
        text("{\"time\":"), number(c.time);
        name("reason"), word(c.reason == CB_NO_ANSWER ? "no_answer" : reason_name(c.reason));
        name("accepted"), text(c.accepted ? "true" : "false");
        name("health"), health(c.health);
        one("latency_s", c.latency), one("pose_age_s", c.pose_age);
        array("point_S_m", c.point, 3), array("filtered_point_S_m", c.filtered_point, 3);
        array("normal_S", c.normal, 3), one("torque_Nm", c.torque_about_normal);
        array("force_S_N", c.force, 3), array("torque_S_Nm", c.torque, 3);
        array("covariance_S_m2", c.covariance, 9), one("within_m", c.within);
        whole("face", c.face), whole("vertex", c.vertex), whole("region", c.region);
        constexpr const char* marks[] = {"measured", "invented", "untouchable"};
        if (c.on >= CB_ON_MEASURED && c.on <= CB_ON_UNTOUCHABLE) name("on"), word(marks[c.on]);
        else null("on");
        whole("candidates", c.candidates), one("confidence", c.confidence);
        one("misfit", c.misfit), one("left_over_Nm", c.left_over), one("arm_m", c.arm);
        one("torsion_arm_m", c.torsion_arm), one("torsion_since_s", c.torsion_since);
        array("runner_up_S_m", c.runner_up, 3), array("second_S_m", c.second, 3);
        text(",\"zero\":{\"state\":"), word(zero_state_name(zero.state));
        one("age_s", zero.age);
        array("force_S_N", zero.force, 3), array("torque_S_Nm", zero.torque, 3);
        one("shift_m", zero.shift), one("shift_sigma_m", zero.shift_sigma);
        if (zero.follows != CB_FOLLOWS_OFF) {
            name("follows"), word(follows_name(zero.follows));
            one("seen_s", zero.seen);
            array("taken_S", c.taken, 6), array("taken_sigma_S", zero.taken_sigma, 6), array("raw_S", c.raw, 6);
        }
        text("}}\n");
    }

    std::string_view view() const noexcept { return {text_, std::size_t(end_ - text_)}; }

private:
    void text(std::string_view t) noexcept { end_ = std::copy(t.begin(), t.end(), end_); }
    void word(std::string_view t) noexcept { text("\""), text(t), text("\""); }
    void name(std::string_view t) noexcept { text(","), word(t), text(":"); }
    void whole(std::string_view t, std::int32_t x) noexcept { name(t), end_ = std::to_chars(end_, end_ + 16, x).ptr; }
    void number(double x) noexcept {
        if (std::isfinite(x)) end_ = std::to_chars(end_, end_ + 32, x).ptr;
        else text("null");
    }
    void null(std::string_view t) noexcept {
        if (nulls_) name(t), text("null");
    }
    void one(std::string_view t, double x) noexcept {
        if (std::isfinite(x)) name(t), number(x);
        else null(t);
    }
    void array(std::string_view t, const double* values, int count) noexcept {
        if (!std::isfinite(values[0])) return null(t);
        name(t);
        for (int i = 0; i < count; ++i) text(i ? "," : "["), number(values[i]);
        text("]");
    }
    void health(std::uint32_t bits) noexcept {
        constexpr const char* names[] = {"frozen", "silent", "flagged", "no_pose", "clock"};
        text("[");
        const char* between = "";
        for (int bit = 0; bit < 5; ++bit)
            if (bits >> bit & 1) text(between), word(names[bit]), between = ",";
        text("]");
    }

    bool nulls_;
    char text_[CB_LINE_ROOM];
    char* end_ = text_;
};

}  // namespace contactbench::runtime
