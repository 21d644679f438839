# SPDX-License-Identifier: GPL-3.0-or-later
flotsam_test(shapes unit SOURCES unit/shapes.cpp LIBRARIES flotsam_geometry)
flotsam_test(stlShape unit SOURCES unit/stlShape.cpp LIBRARIES flotsam_geometry)
flotsam_test(surfaceSpheres unit SOURCES unit/surfaceSpheres.cpp LIBRARIES flotsam_geometry)
flotsam_test(cutSimplex unit SOURCES unit/cutSimplex.cpp LIBRARIES flotsam_geometry)
flotsam_test(cover unit SOURCES unit/cover.cpp LIBRARIES flotsam_geometry flotsam_test_support RANKS 1 2)
flotsam_test(closedSurfaces unit SOURCES unit/closedSurfaces.cpp LIBRARIES flotsam_geometry flotsam_test_support RANKS 1 2)
flotsam_test(wallFilm unit SOURCES unit/wallFilm.cpp LIBRARIES flotsam_geometry flotsam_test_support RANKS 1 2)
flotsam_test(cutGeometry verification SOURCES verification/cutGeometry.cpp LIBRARIES flotsam_geometry flotsam_test_support)
