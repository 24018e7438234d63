// What else the bundle says of gravity and of the mesh, for other programs: the same as contactbench.json does.
#pragma once

#include "config.hpp"
#include "folder.hpp"
#include "ply.hpp"

namespace contactbench::runtime {

// planes.csv: a facet a line, in priority order, n . p + d = 0. Throws LoadError (CB_ERROR_MESH).
void check_planes(const std::string& table, const ProbeMesh& mesh, const Config& config);
// ros2.yaml and, where there is one, ft_calib.yaml. Throws LoadError (CB_ERROR_VALUE).
void check_gravity_files(const Files& files, const GravityLoad& gravity);

}  // namespace contactbench::runtime
