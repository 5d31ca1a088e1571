# Every library that Fluxel stands on; docs/architecture.md says why each is here.
find_package(Threads REQUIRED)
find_package(glm REQUIRED)
find_package(fmt REQUIRED)
find_package(TBB REQUIRED)
find_package(OpenMesh REQUIRED)
find_package(OpenEXR REQUIRED)
find_package(PNG REQUIRED)
find_package(CLI11 REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(tomlplusplus REQUIRED)
find_package(tinyobjloader REQUIRED)
find_package(cereal REQUIRED)
find_package(hwy REQUIRED)
find_package(Boost REQUIRED)
find_package(MPI REQUIRED COMPONENTS CXX)

# Embree 4 where there is one, else 3.13; visibility/embree_compat.hpp hides the difference.
find_package(embree 4 QUIET)
if(NOT embree_FOUND)
  find_package(embree 3.13 REQUIRED)
endif()

find_path(XXHASH_INCLUDE_DIR xxhash.h REQUIRED)
