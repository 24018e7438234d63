#include "physics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "shape.hpp"

namespace contactbench::runtime {

namespace {

constexpr double rounding = 1e-9;
constexpr double sure = 3.0, noise = 2.0;  // sigma
constexpr std::int64_t down_since = 4;     // the version from which on somebody has said where down is
constexpr double most_lean = 0.5;          // cosine of 60 degrees: bases are mounted in multiples of 90
constexpr double largest_error = 0.05;  // m, of what was verified
constexpr double rate_off = 0.05;       // share by which rates may differ and count as the same

// Cholesky's decomposition of the correlations, with room for rounding: units of the rows differ by far.
bool nonnegative_definite(std::vector<double> R, std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) R[i * n + i] += rounding;
    for (std::size_t j = 0; j < n; ++j) {
        for (std::size_t k = 0; k < j; ++k) R[j * n + j] -= R[j * n + k] * R[j * n + k];
        if (!(R[j * n + j] > 0.0)) return false;
        const double root = std::sqrt(R[j * n + j]);
        R[j * n + j] = root;
        for (std::size_t i = j + 1; i < n; ++i) {
            for (std::size_t k = 0; k < j; ++k) R[i * n + j] -= R[i * n + k] * R[j * n + k];
            R[i * n + j] /= root;
        }
    }
    return true;
}

void check_size(const char* field, Vec3 v, double most) {
    if (!(norm(v) <= most)) refuse(field, "larger than any sensor or probe has it: are the units right?");
}

using Row12 = std::array<double, 12>;

// Row `i` of how a predicted reading changes with gravity_W, force_bias, centre_of_mass_S, torque_bias.
Row12 prediction_row(const GravityLoad& load, const double R_SW[3][3], int i) {
    const double L[3] = {load.centre_of_mass_S.x, load.centre_of_mass_S.y, load.centre_of_mass_S.z};
    const double g[3] = {load.gravity_W.x, load.gravity_W.y, load.gravity_W.z};
    Row12 row{};
    if (i < 3) {
        for (int c = 0; c < 3; ++c) row[std::size_t(c)] = R_SW[i][c];
        row[std::size_t(3 + i)] = 1.0;
        return row;
    }
    const int a = i - 3, b = (a + 1) % 3, d = (a + 2) % 3;  // (v x w)_a = v_b w_d - v_d w_b
    double w[3] = {};
    for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c) w[r] += R_SW[r][c] * g[c];
    for (int c = 0; c < 3; ++c) row[std::size_t(c)] = L[b] * R_SW[d][c] - L[d] * R_SW[b][c];
    row[std::size_t(6 + b)] = w[d];
    row[std::size_t(6 + d)] = -w[b];
    row[std::size_t(9 + a)] = 1.0;
    return row;
}

// Adds J C J^T of one orientation, times `weight`.
void add_share(const GravityLoad& load, const std::vector<double>& C, const double R_SW[3][3], double weight,
               double out[6][6]) {
    Row12 J[6], JC[6] = {};
    for (int i = 0; i < 6; ++i) J[i] = prediction_row(load, R_SW, i);
    for (int i = 0; i < 6; ++i)
        for (std::size_t c = 0; c < 12; ++c)
            for (std::size_t k = 0; k < 12; ++k) JC[i][c] += J[i][k] * C[12 * k + c];
    for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 6; ++j)
            for (std::size_t k = 0; k < 12; ++k) out[i][j] += weight * JC[i][k] * J[j][k];
}

// Of a checked object: the number, or nothing where it is null.
std::optional<double> number(const Json& object, std::string_view name) {
    const Json& value = object[name];
    return value.type == Json::Type::null ? std::nullopt : std::optional(value.number);
}

void refuse_above(const std::string& part, const Json& object, const char* name, double most) {
    if (number(object, name).value_or(0.0) > most)
        refuse(part + "." + name, "more than any robot or probe has it: is the unit right?");
}

void check_figures(const Json& v) {
    for (const char* name : {"touches", "markers"})
        if (v[name].integer < 1) refuse(std::string("verification.") + name, "0, but verified is true");
    for (const char* name : {"limit_mean_m", "limit_max_m"}) refuse_above("verification", v, name, largest_error);
    for (const char* name : {"mean_error_m", "p95_error_m"})
        if (v[name].number > v["max_error_m"].number * (1.0 + rounding))
            refuse(std::string("verification.") + name, "more than verification.max_error_m");
}

// Adds what the calibration leaves in a compensated wrench: the mean over the 24 rotations of a cube, which for a
// second degree is that over all rotations.
void mean_share(const GravityLoad& load, const std::vector<double>& C, double out[6][6]) {
    constexpr int turns[6][4] = {{0, 1, 2, 1}, {1, 2, 0, 1}, {2, 0, 1, 1}, {0, 2, 1, -1}, {2, 1, 0, -1}, {1, 0, 2, -1}};
    for (const auto& axes : turns)
        for (int signs = 0; signs < 4; ++signs) {
            const double first = signs & 1 ? -1.0 : 1.0, second = signs & 2 ? -1.0 : 1.0;
            double R[3][3] = {};
            R[0][axes[0]] = first, R[1][axes[1]] = second, R[2][axes[2]] = axes[3] * first * second;
            add_share(load, C, R, 1.0 / 24.0, out);
        }
}

}  // namespace

void refuse(const std::string& field, const std::string& what) { fail(CB_ERROR_VALUE, field, what); }

double weight_sigma(Vec3 weight, const std::vector<double>& C) {
    const double worst = std::sqrt(largest_eigenvalue({{{C[0], C[1], C[2]}, {C[12], C[13], C[14]}, {C[24], C[25], C[26]}}}));
    const double size = norm(weight);
    if (size < sure * worst) return worst;
    const Vec3 Cw{C[0] * weight.x + C[1] * weight.y + C[2] * weight.z,
                  C[12] * weight.x + C[13] * weight.y + C[14] * weight.z,
                  C[24] * weight.x + C[25] * weight.y + C[26] * weight.z};
    return size > 0.0 ? std::sqrt(std::max(dot(weight, Cw), 0.0)) / size : 0.0;
}

void check_covariance(const std::string& field, const std::vector<double>& C, std::size_t n) {
    std::vector<double> deviation(n), R(n * n, 0.0);
    for (std::size_t i = 0; i < n; ++i) {
        if (C[i * n + i] < 0.0) refuse(field, "a variance is below 0");
        deviation[i] = std::sqrt(C[i * n + i]);
    }
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j) {
            const double scale = deviation[i] * deviation[j];
            if (std::fabs(C[i * n + j] - C[j * n + i]) > rounding * scale) refuse(field, "not symmetric");
            if (scale > 0.0) {
                R[i * n + j] = C[i * n + j] / scale;
                if (!(std::fabs(R[i * n + j]) <= 1.0 + rounding)) refuse(field, "a correlation beyond 1");
            }
            if (scale == 0.0 && C[i * n + j] != 0.0) refuse(field, "a covariance where the variance is 0");
        }
    if (!nonnegative_definite(R, n)) refuse(field, "a negative eigenvalue: no noise is like that");
}

void check_gravity(const GravityLoad& load, const std::vector<double>& C, Vec3 down, std::int64_t version) {
    const double weight = norm(load.gravity_W), mass = weight / standard_gravity;
    const double sigma = weight_sigma(load.gravity_W, C) / standard_gravity;
    if (weight > 1000.0 || mass > 50.0) refuse("gravity.gravity_W_N", "heavier than 50 kg: were they grams?");
    if (mass < 0.02 && mass > sure * sigma) refuse("gravity.gravity_W_N", "lighter than 20 g: were they kN?");
    const Vec3 Cd{C[0] * down.x + C[1] * down.y + C[2] * down.z, C[12] * down.x + C[13] * down.y + C[14] * down.z,
                  C[24] * down.x + C[25] * down.y + C[26] * down.z};
    const double along = dot(load.gravity_W, down) + noise * std::sqrt(std::max(dot(down, Cd), 0.0));
    if (along < 0.0) refuse("gravity.gravity_W_N", "points up, against world.down_W");
    if (version >= down_since && mass > sure * sigma && along < most_lean * weight)
        refuse("gravity.gravity_W_N", "more than 60 degrees from world.down_W: how is the robot mounted?");
    check_size("gravity.force_bias_N", load.force_bias, 2000.0);
    check_size("gravity.torque_bias_Nm", load.torque_bias, 200.0);
    check_size("gravity.centre_of_mass_S_m", load.centre_of_mass_S, 2.0);
}

void check_noise(const std::vector<double>& force, const std::vector<double>& torque,
                 const RuntimeSettings& settings, const std::vector<double>& calibration) {
    for (std::size_t i = 0; i < 3; ++i)
        if (!(force[i] > 0.0 && force[i] <= 100.0 && torque[i] > 0.0 && torque[i] <= 10.0))
            refuse("noise", "no sensor has this noise: 0 to 100 N and 0 to 10 N*m, without 0 itself");
    double left = 1.0;  // of the variance of white noise
    if (settings.filter_wrench) {
        const KalmanSettings& k = settings.kalman;
        const double q = k.per_sample ? k.q : k.q * (k.tuned_rate / k.rate);
        const double r = k.per_sample ? k.r : k.r * (k.rate / k.tuned_rate);
        const double predicted = q / 2 + std::sqrt(q) * std::sqrt(q / 4 + r);
        left = predicted / (predicted + 2 * r);
    }
    double wanted[6][6] = {};
    mean_share(settings.gravity, calibration, wanted);
    for (std::size_t i = 0; i < 3; ++i) wanted[i][i] += force[i] * force[i] * left;
    for (std::size_t i = 0; i < 3; ++i) wanted[i + 3][i + 3] += torque[i] * torque[i] * left;
    for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 6; ++j)
            if (!(std::fabs(settings.noise.s[i][j] - wanted[i][j]) <=
                  rounding * std::sqrt(wanted[i][i]) * std::sqrt(wanted[j][j])))
                refuse("noise.wrench_covariance",
                       "not what the noise of a reading, the filter and gravity.covariance make together");
}

void check_verified(const Json& root) {
    if (!root["verified"].boolean) return;
    check_figures(root["verification"]);
    const Json& limits = root["limits"];
    refuse_above("limits", limits, "max_force_N", 1000.0), refuse_above("limits", limits, "max_torque_Nm", 200.0);
    refuse_above("limits", limits, "max_speed_mps", 10.0), refuse_above("limits", limits, "max_turn_radps", 50.0);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const Json& limit = root["gates"]["saturation"].items[axis];
        if (limit.type != Json::Type::null && limit.number < limits["max_force_N"].number)
            refuse("gates.saturation[" + std::to_string(axis) + "]", "the sensor cannot measure limits.max_force_N");
    }
    for (const char* name : {"wrench", "location"}) {
        const Json& filter = root["filters"][name];
        if (filter.type == Json::Type::null) continue;
        if (!(std::fabs(root["sensor"]["rate_Hz"].number / filter["rate_Hz"].number - 1.0) <= rate_off))
            refuse(std::string("filters.") + name + ".rate_Hz", "not sensor.rate_Hz, at which the sensor was verified");
    }
}

}  // namespace contactbench::runtime
