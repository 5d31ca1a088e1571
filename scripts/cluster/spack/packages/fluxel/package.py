from pathlib import Path

from spack.package import *

try:
    from spack_repo.builtin.build_systems.cmake import CMakePackage
except ImportError:
    pass  # spack.package has it before Spack 1.0


class Fluxel(CMakePackage):
    """Distributed MPI radiosity solver for diffuse scenes, with bounds of its error."""

    # The checkout that this recipe stands in: scripts/cluster/spack/packages/fluxel/package.py
    git = Path(__file__).resolve().parents[5].as_uri()

    license("Apache-2.0")

    version("main", branch="main")
    version("0.2.0", tag="v0.2.0")

    variant("cuda", default=False, description="Code for GPUs")

    # Spack has no three.js: pages of runs have tables and charts, and no mesh to turn around.

    depends_on("c", type="build")
    depends_on("cxx", type="build")
    depends_on("cmake@3.25:", type="build")
    depends_on("ninja", type="build")
    depends_on("pkgconfig", type="build")

    depends_on("mpi@3:")
    depends_on("embree@3.13:4")
    depends_on("openmesh@9:")
    depends_on("openexr@3.1:")
    depends_on("glm@0.9.9.8:")
    depends_on("intel-oneapi-tbb@2021:")
    depends_on("highway@1.0.3:")
    depends_on("cli11@2.1:")
    depends_on("tomlplusplus@3.3:")
    depends_on("nlohmann-json@3.11:")
    depends_on("fmt@9:")
    depends_on("tinyobjloader@2.0.0rc10")
    depends_on("libpng@1.6:")
    depends_on("libjpeg-turbo@2:")
    depends_on("cairo@1.16: +fc+ft")
    depends_on("zlib-api")
    depends_on("xxhash@0.8:")
    depends_on("stb")
    depends_on("cereal@1.3:")
    depends_on("boost@1.74:+math+container+random")
    depends_on("cuda@11.8:", when="+cuda")
    depends_on("googletest@1.12:", type="test")
    depends_on("eigen@3.4:", type="test")
    depends_on("python@3.9:", type="test")
    depends_on("py-numpy", type="test")

    generator("ninja")

    def cmake_args(self):
        return [
            self.define("BUILD_TESTING", self.run_tests),
            self.define("FLUXEL_BENCH", False),
            self.define("CMAKE_UNITY_BUILD", True),  # half the time
            self.define_from_variant("FLUXEL_CUDA", "cuda"),
        ]
