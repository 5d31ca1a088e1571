#pragma once

#include "visibility/cuda/device_memory.cuh"
#include "visibility/cuda/scene_arrays.hpp"

namespace fluxel::cuda {

/// A copy of a scene in the memory of the device.
class SceneOnDevice {
 public:
  explicit SceneOnDevice(const SceneArrays& arrays)
      : ends_(copy_to_device(arrays.ends)),
        hulls_(copy_to_device(arrays.hulls)),
        occluders_(copy_to_device(arrays.occluders)),
        exact_(copy_to_device(arrays.exact)),
        nodes_(copy_to_device(arrays.nodes)),
        view_(arrays.view()) {
    view_.ends = ends_.data();
    view_.hulls = hulls_.data();
    view_.occluders = occluders_.data();
    view_.exact = exact_.data();
    view_.nodes = nodes_.data();
  }

  /// For code on the device.
  [[nodiscard]] const TileScene& view() const { return view_; }

 private:
  DeviceArray<End> ends_;
  DeviceArray<GroupHull> hulls_;
  DeviceArray<Occluder> occluders_;
  DeviceArray<ExactPatch> exact_;
  DeviceArray<WideNode> nodes_;
  TileScene view_;
};

}  // namespace fluxel::cuda
