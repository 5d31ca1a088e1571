-- Lmod. Put this folder on MODULEPATH (`module use .../modulefiles`), set `prefix`, name the file after the version.
help([[Fluxel: distributed MPI radiosity solver. `fluxel solve --help` has all options.]])
whatis("Name: Fluxel")
whatis("Version: " .. myModuleVersion())
whatis("Description: distributed MPI radiosity solver for diffuse scenes")

local prefix = "/opt/fluxel"

-- The MPI that it was built with: another one starts copies that know of no other.
depends_on("openmpi")
conflict("fluxel")
prepend_path("PATH", pathJoin(prefix, "bin"))
