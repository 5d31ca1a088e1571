# What an installation has, as two components: the program, and the libraries for other programs (docs/library.md). Each
# is a Debian package (cpack -G DEB in the build folder).
include(GNUInstallDirs)

install(FILES LICENSE README.md CHANGELOG.md CITATION.cff DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY scenes scripts/cluster DESTINATION ${CMAKE_INSTALL_DATADIR}/fluxel USE_SOURCE_PERMISSIONS
        PATTERN spack EXCLUDE PATTERN fluxel.def EXCLUDE)
install(PROGRAMS scripts/chart-forecast scripts/chart-timeline DESTINATION ${CMAKE_INSTALL_DATADIR}/fluxel/scripts)
install(FILES packaging/fluxel.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(FILES packaging/fluxel.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME fluxel)
install(FILES packaging/_fluxel DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions)
# Where Debian's Python looks; elsewhere: pip install ./python.
install(DIRECTORY python/fluxel DESTINATION lib/python3/dist-packages PATTERN __pycache__ EXCLUDE)

# The libraries of all folders but app/: headers below include/fluxel, named there as in this project. Those that need a
# library of which Fluxel's interface is free stay behind, and so do those of the readers of scene files.
set(libraries core sampling scene readers visibility visibility_cuda subdivision formfactor optics solver solver_cuda hierarchy
  photons reference reference_cuda octree final_gather image metrics mpi_master method element_files html
  output)
set(folders core sampling scene visibility subdivision formfactor optics solver hierarchy photons reference octree
  final_gather image metrics mpi_master method output)
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/Fluxel)

add_library(fluxel_all INTERFACE)
target_link_libraries(fluxel_all INTERFACE fluxel_output)
set_target_properties(fluxel_all PROPERTIES EXPORT_NAME fluxel)
# Inline functions round alike in the libraries and in the program that links them.
target_compile_options(fluxel_core INTERFACE
  $<INSTALL_INTERFACE:$<$<COMPILE_LANGUAGE:CXX>:-ffp-contract=off>>)
target_compile_features(fluxel_core INTERFACE cxx_std_20)
if(FLUXEL_WITH_CUDA)
  # CMake adds the run-time library by itself only where CUDA is a language of the project.
  target_link_libraries(fluxel_visibility_cuda INTERFACE $<INSTALL_INTERFACE:CUDA::cudart_static>)
endif()

foreach(library IN LISTS libraries)
  target_include_directories(fluxel_${library} INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/fluxel>)
  set_target_properties(fluxel_${library} PROPERTIES EXPORT_NAME ${library})
  install(TARGETS fluxel_${library} EXPORT FluxelTargets DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
endforeach()
install(TARGETS fluxel_all EXPORT FluxelTargets COMPONENT development)
install(DIRECTORY ${folders} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/fluxel COMPONENT development
        FILES_MATCHING PATTERN *.hpp PATTERN *-inl.hpp EXCLUDE PATTERN embree_compat.hpp EXCLUDE
        PATTERN readers EXCLUDE)
install(EXPORT FluxelTargets NAMESPACE Fluxel:: DESTINATION ${package_folder} COMPONENT development)

include(CMakePackageConfigHelpers)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/FluxelConfig.cmake.in ${PROJECT_BINARY_DIR}/FluxelConfig.cmake
                              INSTALL_DESTINATION ${package_folder})
# Interfaces may change with each minor version (docs/library.md).
write_basic_package_version_file(${PROJECT_BINARY_DIR}/FluxelConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/FluxelConfig.cmake ${PROJECT_BINARY_DIR}/FluxelConfigVersion.cmake
              ${CMAKE_CURRENT_LIST_DIR}/Dependencies.cmake
        DESTINATION ${package_folder} COMPONENT development)
install(DIRECTORY examples DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT development)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_CONTACT "The Fluxel authors <fluxel@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "MPI radiosity of light and heat, with a stated error")
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "Radiosity solver for diffuse scenes that is given an error in place of settings and
 says how accurate its answer is. Runs on one machine or, by MPI, on a cluster.")
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# Starts ranks; false colours need any font.
set(CPACK_DEBIAN_PACKAGE_DEPENDS "openmpi-bin, fonts-dejavu-core")
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "python3-numpy")
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL program development)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME fluxel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME fluxel-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "Libraries, headers and CMake files of Fluxel, for programs that solve by it.")
# What FluxelConfig.cmake finds.
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "g++, cmake, pkg-config, libopenmpi-dev, libembree-dev, libopenmesh-dev, libopenexr-dev,\
 libglm-dev, libtbb-dev, libhwy-dev, libtomlplusplus-dev, nlohmann-json3-dev, libfmt-dev, libtinyobjloader-dev, libpng-dev,\
 libjpeg-dev, libcairo2-dev, zlib1g-dev, libboost-dev")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_RECOMMENDS fluxel)
include(CPack)
