#pragma once

#include <map>
#include <string>

#include "scene/receiver.hpp"

namespace fluxel {

/// What scene files and tables call what a receiver measures.
inline const std::map<std::string, Quantity> kQuantityNames{{"cylindrical", Quantity::cylindrical},
                                                            {"irradiance", Quantity::irradiance},
                                                            {"radiance", Quantity::radiance},
                                                            {"semicylindrical", Quantity::semicylindrical}};

}  // namespace fluxel
