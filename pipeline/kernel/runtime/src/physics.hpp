// What a schema cannot tell, and physics can: the limits are those of the Python loader.
#pragma once

#include <string>
#include <vector>

#include "contactbench/runtime.hpp"

namespace contactbench::runtime {

[[noreturn]] void refuse(const std::string& field, const std::string& what);

// All throw LoadError (CB_ERROR_VALUE). Matrices are row major.
void check_covariance(const std::string& field, const std::vector<double>& C, std::size_t size);
void check_gravity(const GravityLoad& load, const std::vector<double>& covariance);
// The sections against the Butterworth filter that they are said to be, coefficient by coefficient.
void check_low_pass(const std::vector<Section>& sections, double rate, double cutoff, int order);
// The wrench covariance against the noise of a reading, the filter, and the calibration's covariance (12, 12).
void check_noise(const std::vector<double>& force, const std::vector<double>& torque,
                 const RuntimeSettings& settings, const std::vector<double>& calibration);

}  // namespace contactbench::runtime
