# What an installation has beside the program, and the Debian package (cpack -G DEB in the build folder).
include(GNUInstallDirs)

install(FILES LICENSE README.md CHANGELOG.md CITATION.cff DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY scenes scripts/cluster DESTINATION ${CMAKE_INSTALL_DATADIR}/fluxel
        PATTERN spack EXCLUDE PATTERN fluxel.def EXCLUDE)
install(PROGRAMS scripts/chart-forecast scripts/chart-timeline DESTINATION ${CMAKE_INSTALL_DATADIR}/fluxel/scripts)
install(FILES packaging/fluxel.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(FILES packaging/fluxel.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME fluxel)
install(FILES packaging/_fluxel DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions)
# Where Debian's Python looks; elsewhere: pip install ./python.
install(DIRECTORY python/fluxel DESTINATION lib/python3/dist-packages PATTERN __pycache__ EXCLUDE)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_CONTACT "The Fluxel authors <fluxel@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "MPI radiosity of light and heat, with a stated error")
set(CPACK_PACKAGE_DESCRIPTION "Radiosity solver for diffuse scenes that is given an error in place of settings and
 says how accurate its answer is. Runs on one machine or, by MPI, on a cluster.")
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# Starts ranks; false colours need any font.
set(CPACK_DEBIAN_PACKAGE_DEPENDS "openmpi-bin, fonts-dejavu-core")
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "python3-numpy")
set(CPACK_STRIP_FILES ON)
include(CPack)
