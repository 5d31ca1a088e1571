#include "output/elements/solution_writer.hpp"
#include "core/options.hpp"

#include <gtest/gtest.h>

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "core/error.hpp"
#include "core/version.hpp"
#include "tests/unit/file_bytes.hpp"
#include "tests/unit/full_disk.hpp"

namespace fluxel {
namespace {

namespace fs = std::filesystem;

using FaceLight = std::vector<float>;

struct Ply {
  std::vector<std::string> header;  ///< lines
  std::vector<glm::dvec3> vertices;
  std::vector<std::vector<std::uint32_t>> faces;
  std::vector<FaceLight> radiosity;  ///< front, or front and back
  std::vector<std::uint32_t> patch;
  std::size_t bytes_left = 0;
};

template <class T>
T take(std::istream& stream) {
  T value{};
  stream.read(reinterpret_cast<char*>(&value), sizeof(T));
  if (!stream) throw std::runtime_error("the PLY file is too short");
  return value;
}

Ply read_ply(const fs::path& file) {
  Ply ply;
  std::istringstream stream(bytes_of(file));
  std::size_t vertices = 0, faces = 0, floats = 0;
  for (std::string line; std::getline(stream, line) && line != "end_header";) {
    ply.header.push_back(line);
    if (line.starts_with("element vertex ")) vertices = std::stoul(line.substr(15));
    if (line.starts_with("element face ")) faces = std::stoul(line.substr(13));
    if (line.starts_with("property float radiosity")) ++floats;
  }
  for (std::size_t i = 0; i < vertices; ++i) {
    const auto x = take<double>(stream), y = take<double>(stream), z = take<double>(stream);
    ply.vertices.emplace_back(x, y, z);
  }
  for (std::size_t i = 0; i < faces; ++i) {
    std::vector<std::uint32_t> face(take<std::uint8_t>(stream));
    for (auto& vertex : face) vertex = take<std::uint32_t>(stream);
    ply.faces.push_back(face);
    FaceLight light(floats);
    for (auto& value : light) value = take<float>(stream);
    ply.radiosity.push_back(light);
    ply.patch.push_back(take<std::uint32_t>(stream));
  }
  const std::string rest{std::istreambuf_iterator<char>(stream), {}};
  ply.bytes_left = rest.size();
  return ply;
}

class SolutionFile : public testing::Test {
 protected:
  void SetUp() override {
    folder =
        fs::path(testing::TempDir()) /
        ("fluxel_solution_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder);
    fs::create_directories(folder);
    file = folder / "solution.ply";
  }
  void TearDown() override { fs::remove_all(folder); }

  void add(std::vector<glm::vec3> corners) {
    Outline<glm::vec3> outline;
    outline.corners = static_cast<std::uint32_t>(corners.size());
    std::copy(corners.begin(), corners.end(), outline.corner.begin());
    const auto n = static_cast<double>(mesh.elements.size());
    Element element;
    element.patch = PatchId{static_cast<std::uint32_t>(7 + mesh.elements.size())};
    mesh.elements.push_back(element);
    mesh.outlines.push_back(outline);
    light.B_front.emplace_back(n + 0.1, n + 0.2, n + 0.3);
    light.B_back.emplace_back(n + 10.1, n + 10.2, n + 10.3);
  }

  /// A square and a triangle on its side x = 1.
  void add_square_and_triangle() {
    add({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    add({{1, 0, 0}, {2, 0, 0}, {1, 1, 0}});
  }

  /// The corners in the file are those of the elements, in their order.
  void expect_all_faces(const Ply& ply) const {
    ASSERT_EQ(ply.faces.size(), mesh.outlines.size());
    for (std::size_t i = 0; i < ply.faces.size(); ++i) {
      ASSERT_EQ(ply.faces[i].size(), mesh.outlines[i].corners);
      for (std::size_t c = 0; c < ply.faces[i].size(); ++c) {
        EXPECT_EQ(ply.vertices.at(ply.faces[i][c]), scene.origin + glm::dvec3(mesh.outlines[i].corner[c]));
      }
      EXPECT_EQ(ply.patch[i], 7 + i);
    }
    EXPECT_EQ(ply.bytes_left, 0u);
  }

  Scene scene;
  ElementMesh mesh;
  SurfaceLight light;
  fs::path folder, file;
};

TEST_F(SolutionFile, HeaderIsAsPromised) {
  add_square_and_triangle();
  write_solution(file, scene, mesh, light);
  std::vector<std::string> header;
  bool names_version = false;
  for (const std::string& line : read_ply(file).header) {
    if (!line.starts_with("comment")) header.push_back(line);
    names_version = names_version || line == "comment Fluxel " + version();
  }
  EXPECT_TRUE(names_version);
  const std::vector<std::string> expected = {"ply",
                                             "format binary_little_endian 1.0",
                                             "element vertex 5",
                                             "property double x",
                                             "property double y",
                                             "property double z",
                                             "element face 2",
                                             "property list uchar uint vertex_indices",
                                             "property float radiosity_r",
                                             "property float radiosity_g",
                                             "property float radiosity_b",
                                             "property float radiosity_back_r",
                                             "property float radiosity_back_g",
                                             "property float radiosity_back_b",
                                             "property uint patch"};
  EXPECT_EQ(header, expected);
}

TEST_F(SolutionFile, HoldsEveryElementWithItsLight) {
  scene.origin = {4e6 + 1.0 / 3, -2, 0.5};  // where single precision would move the corners by up to 0.25 m
  add_square_and_triangle();
  write_solution(file, scene, mesh, light);
  const Ply ply = read_ply(file);
  expect_all_faces(ply);
  EXPECT_EQ(ply.vertices.size(), 5u);  // the common side is welded
  EXPECT_EQ(ply.radiosity[0], (FaceLight{0.1f, 0.2f, 0.3f, 10.1f, 10.2f, 10.3f}));
  EXPECT_EQ(ply.radiosity[1], (FaceLight{1.1f, 1.2f, 1.3f, 11.1f, 11.2f, 11.3f}));
}

TEST_F(SolutionFile, OneSidedSceneHasNoBack) {
  add_square_and_triangle();
  light.B_back.clear();
  write_solution(file, scene, mesh, light);
  const Ply ply = read_ply(file);
  expect_all_faces(ply);
  EXPECT_EQ(ply.radiosity[1], (FaceLight{1.1f, 1.2f, 1.3f}));
}

TEST_F(SolutionFile, NonManifoldAndDegenerateFacesAreKept) {
  testing::internal::CaptureStderr();
  // Three faces on one edge, one of them in the other's orientation, a face twice, and one without area.
  add({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  add({{0, 0, 0}, {1, 0, 0}, {0, -1, 0}});
  add({{1, 0, 0}, {0, 0, 0}, {0, 0, 1}});
  add({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  add({{5, 5, 5}, {5, 5, 5}, {6, 5, 5}});
  // A bow tie: two faces that share one corner only, and a third there.
  add({{0, 0, 0}, {-1, 0, 0}, {-1, -1, 0}});
  add({{0, 0, 0}, {-1, 1, 3}, {-1, 2, 3}});
  write_solution(file, scene, mesh, light);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  expect_all_faces(read_ply(file));
}

TEST_F(SolutionFile, ZeroAndMinusZeroAreOneVertex) {
  add({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  add({{1, 0, -0.0f}, {1, 1, 0}, {-0.0f, 1, 0}});
  write_solution(file, scene, mesh, light);
  EXPECT_EQ(read_ply(file).vertices.size(), 4u);
}

TEST_F(SolutionFile, OpenMeshReadsIt) {
  add_square_and_triangle();
  light.B_back.clear();
  write_solution(file, scene, mesh, light);
  OpenMesh::PolyMesh_ArrayKernelT<> read;
  OpenMesh::FPropHandleT<float> radiosity;
  OpenMesh::FPropHandleT<unsigned> patch;
  OpenMesh::IO::Options options(OpenMesh::IO::Options::Custom);
  ASSERT_TRUE(OpenMesh::IO::read_mesh(read, file.string(), options));
  ASSERT_EQ(read.n_vertices(), 5u);
  ASSERT_EQ(read.n_faces(), 2u);
  EXPECT_EQ(read.n_edges(), 6u);  // four of the square, two more of the triangle
  ASSERT_TRUE(read.get_property_handle(radiosity, "radiosity_g"));
  ASSERT_TRUE(read.get_property_handle(patch, "patch"));
  for (const auto face : read.faces()) {
    const auto i = static_cast<std::size_t>(face.idx());
    EXPECT_EQ(read.property(radiosity, face), static_cast<float>(light.B_front[i].g));
    EXPECT_EQ(read.property(patch, face), 7 + i);
    EXPECT_EQ(face.valence(), mesh.outlines[i].corners);
  }
}

TEST_F(SolutionFile, HasTheSameBytesAgain) {
  add_square_and_triangle();
  write_solution(file, scene, mesh, light);
  write_solution(folder / "again.ply", scene, mesh, light);
  EXPECT_EQ(bytes_of(file), bytes_of(folder / "again.ply"));
}

TEST_F(SolutionFile, RefusesARadiosityThatIsNotFinite) {
  add_square_and_triangle();
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(), 1e300}) {
    SurfaceLight broken = light;
    broken.B_front[1].g = bad;
    EXPECT_THROW(write_solution(file, scene, mesh, broken), std::logic_error);
    broken = light;
    broken.B_back[0].b = -bad;
    EXPECT_THROW(write_solution(file, scene, mesh, broken), std::logic_error);
  }
  light.B_front.pop_back();
  EXPECT_THROW(write_solution(file, scene, mesh, light), std::logic_error);
  EXPECT_TRUE(fs::is_empty(folder));
}

TEST_F(SolutionFile, AFullDiskIsAnInputErrorAndLeavesNothing) {
  add_square_and_triangle();
  {
    const FullDisk full;
    EXPECT_THROW(write_solution(file, scene, mesh, light), InputError);
  }
  EXPECT_TRUE(fs::is_empty(folder));
}

/// As the file holds it.
FaceLight single(const Rgb& B) {
  return {static_cast<float>(B.r), static_cast<float>(B.g), static_cast<float>(B.b)};
}

TEST_F(SolutionFile, IsReadBack) {
  scene.origin = {4e6 + 1.0 / 3, -2, 0.5};
  add_square_and_triangle();
  for (const bool two_sided : {true, false}) {
    if (!two_sided) light.B_back.clear();
    write_solution(file, scene, mesh, light);
    const std::vector<Rgb> B = read_solution(file, scene, mesh, two_sided);
    ASSERT_EQ(B.size(), two_sided ? 4u : 2u);
    for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(single(B[i]), single(light.B_front[i]));
    for (std::size_t i = 2; i < B.size(); ++i) EXPECT_EQ(single(B[i]), single(light.B_back[i - 2]));
  }
}

TEST_F(SolutionFile, OfAnotherVersionIsReadBack) {
  add_square_and_triangle();
  write_solution(file, scene, mesh, light);
  std::string bytes = bytes_of(file);
  bytes.replace(bytes.find(version()), version().size(), "0.0.0-of-long-ago");
  std::ofstream(file, std::ios::binary) << bytes;
  EXPECT_EQ(single(read_solution(file, scene, mesh, true)[1]), single(light.B_front[1]));
}

TEST_F(SolutionFile, OfOtherElementsIsRefused) {
  add_square_and_triangle();
  write_solution(file, scene, mesh, light);
  const std::string bytes = bytes_of(file);
  EXPECT_THROW(static_cast<void>(read_solution(file, scene, mesh, false)), InputError);
  ElementMesh moved = mesh;
  moved.outlines[1].corner[1].x += 0x1p-20f;
  EXPECT_THROW(static_cast<void>(read_solution(file, scene, moved, true)), InputError);
  ElementMesh of_another_patch = mesh;
  of_another_patch.elements[1].patch = PatchId{9};
  EXPECT_THROW(static_cast<void>(read_solution(file, scene, of_another_patch, true)), InputError);
  EXPECT_THROW(static_cast<void>(read_solution(folder / "none.ply", scene, mesh, true)), InputError);
}

// Every byte but those of the radiosities and the version's name matters, and no length is taken for granted.
TEST_F(SolutionFile, DamageIsRefused) {
  add_square_and_triangle();
  write_solution(file, scene, mesh, light);
  const std::string bytes = bytes_of(file);
  const auto is_refused = [&](const std::string& damaged) {
    std::ofstream(file, std::ios::binary) << damaged;
    try {
      static_cast<void>(read_solution(file, scene, mesh, true));
    } catch (const InputError&) {
      return true;
    }
    return false;
  };
  for (std::size_t length = 0; length < bytes.size(); length += 7)
    EXPECT_TRUE(is_refused(bytes.substr(0, length))) << length;
  EXPECT_TRUE(is_refused(bytes + "x"));
  std::size_t accepted = 0;
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    std::string damaged = bytes;
    damaged[at] = static_cast<char>(damaged[at] ^ 1);
    if (!is_refused(damaged)) ++accepted;
  }
  // 12 floats; and the version's name, which may be any other.
  EXPECT_EQ(accepted, 12 * sizeof(float) + version().size());
}

TEST_F(SolutionFile, ThatIsNotFiniteIsRefused) {
  add_square_and_triangle();
  write_solution(file, scene, mesh, light);
  std::string bytes = bytes_of(file);
  const std::size_t radiosity = bytes.size() - 4 - 6 * sizeof(float);
  const float nothing = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(bytes.data() + radiosity, &nothing, sizeof nothing);
  std::ofstream(file, std::ios::binary) << bytes;
  EXPECT_THROW(static_cast<void>(read_solution(file, scene, mesh, true)), InputError);
}

}  // namespace
}  // namespace fluxel
