// planes.csv: what the mesh says, for other programs.
#pragma once

#include "config.hpp"
#include "folder.hpp"
#include "ply.hpp"

namespace contactbench::runtime {

// A facet a line, in priority order, n . p + d = 0; to the byte as contactbench writes it. Throws LoadError
// (CB_ERROR_MESH), also for a facet without area.
void check_planes(const std::string& table, const ProbeMesh& mesh, const Config& config);

}  // namespace contactbench::runtime
