# SPDX-License-Identifier: GPL-3.0-or-later
# LIGGGHTS' library and its C++ headers (Debian: libliggghts-dev). Target LIGGGHTS::LIGGGHTS.
include(FindPackageHandleStandardArgs)
find_path(LIGGGHTS_INCLUDE_DIR NAMES fix_multisphere.h PATH_SUFFIXES liggghts)
find_library(LIGGGHTS_LIBRARY NAMES liggghts)
find_package_handle_standard_args(LIGGGHTS REQUIRED_VARS LIGGGHTS_LIBRARY LIGGGHTS_INCLUDE_DIR)
if(LIGGGHTS_FOUND AND NOT TARGET LIGGGHTS::LIGGGHTS)
  add_library(LIGGGHTS::LIGGGHTS UNKNOWN IMPORTED)
  set_target_properties(LIGGGHTS::LIGGGHTS PROPERTIES IMPORTED_LOCATION "${LIGGGHTS_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${LIGGGHTS_INCLUDE_DIR}")
endif()
