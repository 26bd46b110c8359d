# SPDX-License-Identifier: Apache-2.0
# `cpack` in a build folder makes a Debian package (cpack -G TGZ: an archive).
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME treefarm)
set(CPACK_PACKAGE_VENDOR "Treefarm")
set(CPACK_PACKAGE_CONTACT "Treefarm maintainers <maintainers@treefarm.invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGE_DESCRIPTION "Renders Mitsuba scenes by path tracing that learns where light comes from, in one process or under mpirun.
 Workers learn one guiding tree together; images have the same bits for any number of them.")
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# mpirun is no library; without gnuplot a report has no charts.
set(CPACK_DEBIAN_PACKAGE_DEPENDS "openmpi-bin")
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "gnuplot-nox, openssh-client")
include(CPack)
