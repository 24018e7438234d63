// ros2.yaml and ft_calib.yaml: what gravity in contactbench.json says, for other programs.
#pragma once

#include <string>
#include <vector>

#include "contactbench/runtime.hpp"
#include "folder.hpp"

namespace contactbench::runtime {

// To the byte as contactbench.pipeline.config.consumers writes them, whose text this file repeats; names of frames and nodes are taken
// from the head of each. `covariance` is that of the calibration (12, 12), `down_W` a unit vector. Throws LoadError
// (CB_ERROR_VALUE).
void check_gravity_files(const Files& files, const GravityLoad& gravity, const std::vector<double>& covariance,
                         Vec3 down_W);

}  // namespace contactbench::runtime
