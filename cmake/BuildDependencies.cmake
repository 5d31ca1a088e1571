# Headers and texts that are compiled in: whoever links Fluxel's libraries needs none of them.
find_package(CLI11 REQUIRED)
find_package(cereal REQUIRED)
find_path(XXHASH_INCLUDE_DIR xxhash.h REQUIRED)
# three.js r111, as Debian has it; without it the pages of runs have no mesh. https://threejs.org
find_path(THREE_JS_DIR three.min.js PATHS /usr/share/javascript/three)
find_path(STB_INCLUDE_DIR stb/stb_rect_pack.h REQUIRED)
