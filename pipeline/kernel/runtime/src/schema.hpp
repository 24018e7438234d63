// Made from pipeline/config/runtime/model.py by packaging/declarations.py: change that, not this.
#pragma once

#include "shape.hpp"

namespace contactbench::runtime::schema {

inline constexpr Member UnitsPart[] = {{"force", one_of("N")}, {"torque", one_of("N*m")}, {"length", one_of("m")},
    {"time", one_of("s")}, {"angle", one_of("rad")}};
inline constexpr Member FramesPart[] = {{"sensor", one_of("S")}, {"world", one_of("W")},
    {"rotation", one_of("R_WS: v_W = R_WS v_S")},
    {"wrench", one_of("what the tissue does to the probe, about the origin of S")},
    {"quaternion_ES", or_null(array(any, 4, 4))}};
inline constexpr Member WorldPart[] = {{"down_W", array(any, 3, 3)}};
inline constexpr Member SensorPart[] = {{"model", text(1000)}, {"serial", text(1000)}, {"rate_Hz", positive}};
inline constexpr Shape each_1 = array(any, 12, 12);
inline constexpr Member GravityPart[] = {{"gravity_W_N", array(any, 3, 3)}, {"force_bias_N", array(any, 3, 3)},
    {"centre_of_mass_S_m", array(any, 3, 3)}, {"torque_bias_Nm", array(any, 3, 3)},
    {"covariance", array(each_1, 12, 12)}};
inline constexpr Member DriftPart[] = {{"force_Nps", array(any, 3, 3)}, {"torque_Nmps", array(any, 3, 3)},
    {"force_sigma_Nps", array(not_negative, 3, 3)}, {"torque_sigma_Nmps", array(not_negative, 3, 3)}};
inline constexpr Member ZeroPart[] = {{"measured", or_null(formatted(Format::time))},
    {"drift", or_null(object(DriftPart))}, {"follow", flag, true}};
inline constexpr Shape each_2 = array(any, 6, 6);
inline constexpr Member NoisePart[] = {{"force_N", array(not_negative, 3, 3)},
    {"torque_Nm", array(not_negative, 3, 3)}, {"orientation_rad", or_null(number(0, 0.5))},
    {"wrench_covariance", array(each_2, 6, 6)}};
inline constexpr Shape each_3 = number(0, 100);
inline constexpr Shape each_4 = number(0, 10);
inline constexpr Member ModelErrorPart[] = {{"force_N", array(each_3, 3, 3)}, {"torque_Nm", array(each_4, 3, 3)},
    {"measured", flag}};
inline constexpr Member TouchModelPart[] = {{"torsion_arm_m", number(0, 0.1)},
    {"model_error", object(ModelErrorPart)}, {"mesh_deviation_m", number(0, 0.1)}, {"mesh_curved", flag},
    {"torsion", one_of("learned|fixed"), true}, {"scene", or_null(one_of("dry|gel|bone")), true}};
inline constexpr Member MotionPart[] = {{"window_s", number(0.02, 2)}, {"gyration_m", number(0, 1)}};
inline constexpr Member StreamsPart[] = {{"pose_gap_s", number(0, 10, true, false)}, {"pose_ahead_s", number(0, 10)},
    {"silence_s", number(0, 10, true, false)}, {"frozen_probability", number(1e-30, 0.001)},
    {"motion", or_null(object(MotionPart))}};
inline constexpr Member KalmanPart[] = {{"kind", one_of("kalman|adaptive")}, {"rate_Hz", positive}, {"q", positive},
    {"r", positive}, {"tuned_rate_Hz", positive}, {"per_sample", flag}};
inline constexpr Member LowPassPart[] = {{"kind", one_of("lowpass")}, {"rate_Hz", positive}, {"cutoff_Hz", positive},
    {"order", integer(1, 8)}, {"sections", array(each_2, 1, 4)}};
inline constexpr Member FiltersPart[] = {{"wrench", or_null(object(KalmanPart))},
    {"location", or_null(object(LowPassPart))}};
inline constexpr Shape each_5 = or_null(positive);
inline constexpr Member GatesPart[] = {{"min_force_N", not_negative},
    {"friction_angle_rad", number(0, 1.5708, true, true)}, {"ambiguity_distance_m", not_negative},
    {"implausible_misfit", number(0.45, 37.4)}, {"rival_odds", number(1, 1000000000.0)},
    {"first_odds", number(1, 1000000000.0)}, {"follow_odds", number(1, 1000000000.0)},
    {"follow_distance_m", not_negative}, {"recent_samples", integer(0, 2147483647)}, {"max_age_s", not_negative},
    {"saturation", array(each_5, 6, 6)}, {"region_only", flag}, {"accept_by_region", flag},
    {"sigma_max_m", not_negative, true}, {"depth_distance_m", not_negative, true}};
inline constexpr Shape each_6 = array(any, 3, 3);
inline constexpr Member ProbePart[] = {{"file", formatted(Format::file)}, {"name", text(1000)},
    {"facets", integer(4, 2000000)}, {"vertices", integer(4, 2000000)}, {"bounds_S_m", array(each_6, 2, 2)}};
inline constexpr Member RegionPart[] = {{"rank", integer(1, 1000)}, {"name", text(1000)},
    {"colour", formatted(Format::colour)}, {"facets", integer(0, 2147483647)}, {"odds", number(1e-09, 1000000000.0)},
    {"untouchable", flag}};
inline constexpr Shape each_7 = object(RegionPart);
inline constexpr Member PlanesPart[] = {{"file", formatted(Format::file)}, {"count", integer(0, 2147483647)}};
inline constexpr Member ForceGainsPart[] = {{"mass_kg", positive}, {"damping_Nspm", positive},
    {"stiffness_Npm", not_negative}, {"gain_per_s", positive}};
inline constexpr Member AngleGainsPart[] = {{"inertia", array(positive, 2, 2)}, {"damping", array(positive, 2, 2)},
    {"stiffness", array(not_negative, 2, 2)}, {"gain_per_s", array(positive, 2, 2)}, {"settling_s", positive}};
inline constexpr Member LeadPart[] = {{"bandwidth_per_s", array(positive, 3, 3)}, {"smoothing_s", positive},
    {"lean_rad", positive}, {"lean_s", positive}};
inline constexpr Member TouchPart[] = {{"approach_speed_mps", positive}, {"approach_travel_m", positive},
    {"retract_speed_mps", positive}, {"retract_travel_m", positive}, {"touch_force_N", positive},
    {"low_force_N", positive}, {"ramp_s", positive}, {"probing_m", not_negative},
    {"attempts", integer(0, 2147483647)}};
inline constexpr Member ToolPart[] = {{"left_force_N", positive}, {"left_torque_Nm", positive},
    {"taring_s", not_negative}, {"gyration_m", not_negative}};
inline constexpr Member WatchPart[] = {{"stale_s", positive}, {"give_up_s", positive}, {"following_s", positive},
    {"max_tilt_rad", number(0, 1.5708, true, true)}};
inline constexpr Member ControllerPart[] = {{"variant", one_of("plain|aware")}, {"desired_force_N", positive},
    {"period_s", positive}, {"servo_lag_s", not_negative}, {"force", object(ForceGainsPart)},
    {"angle", object(AngleGainsPart)}, {"lead", object(LeadPart)}, {"touch", object(TouchPart)},
    {"tool", object(ToolPart)}, {"watch", object(WatchPart)}};
inline constexpr Member LimitsPart[] = {{"max_force_N", positive}, {"max_torque_Nm", positive},
    {"max_speed_mps", or_null(positive)}, {"max_turn_radps", or_null(positive)}};
inline constexpr Member VerificationPart[] = {{"touches", integer(0, 2147483647)},
    {"markers", integer(0, 2147483647)}, {"mean_error_m", not_negative}, {"sd_error_m", not_negative},
    {"p95_error_m", not_negative}, {"max_error_m", not_negative}, {"ratio", or_null(not_negative)},
    {"p99_time_s", or_null(not_negative)}, {"limit_mean_m", positive}, {"limit_max_m", positive}, {"passed", flag},
    {"diagnosis", text(10000)}};
inline constexpr Member KnownWeightPart[] = {{"mass_kg", positive}, {"mass_sigma_kg", not_negative},
    {"certificate", or_null(text(1000))}, {"measured_kg", any}, {"measured_sigma_kg", not_negative},
    {"outcome", one_of("passed|failed|undecided")}, {"created", or_null(formatted(Format::time))}};
inline constexpr Member KnownTouchPart[] = {{"point_S_m", array(any, 3, 3)},
    {"located_S_m", or_null(array(any, 3, 3))}, {"error_m", or_null(not_negative)},
    {"sigma_m", or_null(not_negative)}, {"outcome", one_of("passed|failed|undecided")},
    {"created", or_null(formatted(Format::time))}};
inline constexpr Member ChecksPart[] = {{"known_weight", or_null(object(KnownWeightPart))},
    {"known_touch", or_null(object(KnownTouchPart))}};
inline constexpr Member SelfTestPart[] = {{"file", formatted(Format::file)}, {"samples", integer(1, 100000)}};
inline constexpr Member SourcePart[] = {{"role", text(1000)}, {"name", text(1000)},
    {"sha256", formatted(Format::hash)}};
inline constexpr Shape each_8 = object(SourcePart);
inline constexpr Shape each_9 = text(1000);
inline constexpr Member ProvenancePart[] = {{"created", formatted(Format::time)}, {"tool", text(1000)},
    {"operator", text(1000)}, {"session", or_null(text(1000))}, {"files", files(1, 50)},
    {"sources", array(each_8, 0, 200)}, {"stale", array(each_9, 0, 100)}};
inline constexpr Member Runtime[] = {{"schema", one_of("contactbench.runtime")}, {"version", integer(1, 4)},
    {"units", object(UnitsPart)}, {"frames", object(FramesPart)}, {"world", object(WorldPart)},
    {"sensor", object(SensorPart)}, {"gravity", object(GravityPart)}, {"zero", object(ZeroPart)},
    {"noise", object(NoisePart)}, {"touch", object(TouchModelPart)}, {"streams", object(StreamsPart)},
    {"filters", object(FiltersPart)}, {"gates", object(GatesPart)}, {"probe", object(ProbePart)},
    {"regions", array(each_7, 0, 1000)}, {"planes", object(PlanesPart)},
    {"controller", or_null(object(ControllerPart))}, {"limits", object(LimitsPart)},
    {"verification", or_null(object(VerificationPart))}, {"checks", object(ChecksPart)},
    {"self_test", or_null(object(SelfTestPart))}, {"verified", flag}, {"provenance", object(ProvenancePart)}};

}  // namespace contactbench::runtime::schema
