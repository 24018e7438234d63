// A bundle's folder: its files read once, their hashes checked, its probe built.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "config.hpp"

namespace contactbench::runtime {

struct Bundle {
    Config config;
    std::shared_ptr<const Model> model;
    std::vector<std::uint8_t> marks;  // of each facet: CB_ON_*
};

// Throws LoadError, or std::bad_alloc.
Bundle load_bundle(const std::string& folder);

}  // namespace contactbench::runtime
