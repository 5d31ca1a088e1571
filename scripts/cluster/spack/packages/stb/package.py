import glob

from spack.package import *

try:
    from spack_repo.builtin.build_systems.generic import Package
except ImportError:
    pass  # spack.package has it before Spack 1.0


class Stb(Package):
    """Single-file libraries for C and C++, of which Fluxel takes stb_rect_pack. They have no releases."""

    homepage = "https://github.com/nothings/stb"
    git = "https://github.com/nothings/stb.git"

    license("MIT OR Unlicense")

    version("master", branch="master")

    def install(self, spec, prefix):
        mkdirp(prefix.include.stb)
        for header in glob.glob("*.h"):
            install(header, prefix.include.stb)
