from spack.package import *

try:
    from spack_repo.builtin.build_systems.cmake import CMakePackage
except ImportError:
    pass  # spack.package has it before Spack 1.0


class Tinyobjloader(CMakePackage):
    """Reader of Wavefront OBJ files. Spack's own recipe ends at 1.0.6, which has neither exact numbers nor PBR materials."""

    homepage = "https://github.com/tinyobjloader/tinyobjloader"
    git = "https://github.com/tinyobjloader/tinyobjloader.git"

    license("MIT")

    version("2.0.0rc10", tag="v2.0.0rc10")

    depends_on("cxx", type="build")
    depends_on("cmake@3.2:", type="build")

    def cmake_args(self):
        return [self.define("TINYOBJLOADER_USE_DOUBLE", True)]
