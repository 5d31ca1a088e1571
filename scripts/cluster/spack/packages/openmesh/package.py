from spack.package import *

try:
    from spack_repo.builtin.build_systems.cmake import CMakePackage
except ImportError:
    pass  # spack.package has it before Spack 1.0


class Openmesh(CMakePackage):
    """Half-edge data structure for polygonal meshes."""

    homepage = "https://www.graphics.rwth-aachen.de/software/openmesh"
    git = "https://gitlab.vci.rwth-aachen.de:9000/OpenMesh/OpenMesh.git"

    license("BSD-3-Clause")

    version("9.0", tag="OpenMesh-9.0", submodules=True)

    depends_on("c", type="build")
    depends_on("cxx", type="build")
    depends_on("cmake@3.3:", type="build")

    def cmake_args(self):
        return [self.define("BUILD_APPS", False)]
