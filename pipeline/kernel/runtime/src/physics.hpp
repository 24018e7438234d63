// What a schema cannot tell, and physics can: the limits are those of the Python loader.
#pragma once

#include <string>
#include <vector>

#include "contactbench/runtime.hpp"
#include "json.hpp"

namespace contactbench::runtime {

[[noreturn]] void refuse(const std::string& field, const std::string& what);

// All throw LoadError (CB_ERROR_VALUE). Matrices are row major.
void check_covariance(const std::string& field, const std::vector<double>& C, std::size_t size);
// `version`: of the schema, as the config was written.
void check_gravity(const GravityLoad& load, const std::vector<double>& covariance, Vec3 down_W, std::int64_t version);
// The sections against the Butterworth filter that they are said to be, coefficient by coefficient.
void check_low_pass(const std::vector<Section>& sections, double rate, double cutoff, int order);
// The wrench covariance against the noise of a reading, the filter, and the calibration's covariance (12, 12).
void check_noise(const std::vector<double>& force, const std::vector<double>& torque,
                 const RuntimeSettings& settings, const std::vector<double>& calibration);

// What cannot be true of a config that was verified. `root` is contactbench.json, every field of which was checked.
void check_verified(const Json& root);
// Standard deviation of the weight's size, N; in the worst direction, where the weight's own is hardly known.
double weight_sigma(Vec3 weight, const std::vector<double>& calibration);

}  // namespace contactbench::runtime
