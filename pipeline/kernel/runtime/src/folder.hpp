// A bundle's folder, read at one moment.
#pragma once

#include <map>
#include <string>

#include "errors.hpp"

namespace contactbench::runtime {

inline constexpr const char *config_name = "contactbench.json", *checksum_name = "contactbench.sha256";
inline constexpr const char *planes_name = "planes.csv", *ros2_name = "ros2.yaml", *ft_calib_name = "ft_calib.yaml";
inline constexpr const char* self_test_name = "self_test.csv";

using Files = std::map<std::string, std::string>;

[[noreturn]] void refuse_file(int code, const std::string& file, const std::string& what);

// Every file once, all of one export: a folder that another takes the place of is read again. Throws LoadError
// (CB_ERROR_FILE).
Files read_folder(const std::string& folder);

}  // namespace contactbench::runtime
