#pragma once

#include <map>
#include <string>

namespace fluxel {

/// What has ended a run's rounds before their goal.
enum class RunLimit { memory, time, signal };
inline const std::map<std::string, RunLimit> kRunLimitNames{
    {"memory", RunLimit::memory}, {"time", RunLimit::time}, {"signal", RunLimit::signal}};

}  // namespace fluxel
