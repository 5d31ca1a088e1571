#pragma once

#include <stdexcept>

namespace fluxel {

/// A ray has a component that is not a number, infinite, or beyond what Embree traces (1.8e18): a defect of
/// the caller. Embree would abort or, where it is built without assertions, answer anything; a ray left out
/// would only hide in the result what is wrong. So the run ends and says so.
class UntraceableRay : public std::logic_error {
 public:
  UntraceableRay()
      : std::logic_error("a ray is not finite: a defect of the program, please report the scene") {}
};

}  // namespace fluxel
