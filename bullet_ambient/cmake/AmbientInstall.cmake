# What `cmake --install` puts where. One export set for each thing a program may use without the others:
#   Core                   the boxes without Bullet
#   float32, float64       the runtime for one precision of Bullet
#   Preprocess             the offline library, Preprocess_float32/_float64 what of it includes Bullet
# so that a program for one precision does not need the Bullet of the other.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(BULLET_AMBIENT_PACKAGE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/BulletAmbient)

# ambient_install_box(NAME [float32|float64]): adds the box to the export set chosen by its folder and its precision.
# Demos and tests are not installed.
function(ambient_install_box name)
  file(RELATIVE_PATH folder ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR})
  if(folder MATCHES "^bullet_ambient/")
    set(export ${ARGN})
    if(NOT export)
      set(export Core)
    endif()
    set(include_dir ${CMAKE_INSTALL_INCLUDEDIR})
  elseif(folder MATCHES "^preprocess/")
    set(export Preprocess ${ARGN})
    list(JOIN export "_" export)
    set(include_dir ${CMAKE_INSTALL_INCLUDEDIR}/bullet_ambient)
  else()
    return()
  endif()
  set_property(GLOBAL APPEND PROPERTY BULLET_AMBIENT_EXPORTS ${export})
  set_property(GLOBAL APPEND PROPERTY BULLET_AMBIENT_BOXES_${export} ${name})
  install(TARGETS ${name} EXPORT BulletAmbientTargets-${export}
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
    INCLUDES DESTINATION ${include_dir})
endfunction()

# The public headers: what programs include, and what that includes. Everything else is free to change.
set(BULLET_AMBIENT_PUBLIC_HEADERS
  ambient.h
  bullet/ambient_action.h
  bullet/ambient_impulse.h
  bullet/ambient_registry.h
  bullet/ambient_serializer.h
  bullet/ambient_solver.h
  bullet/attach_def.h
  bullet/bullet_task_runner.h
  bullet/conversions.h
  bullet/fluid.h
  bullet/fluid_body_source.h
  bullet/fluid_drawing.h
  bullet/multibody_dynamics.h
  bullet/precision_check.h
  bullet/region_id.h
  bullet/solver_group.h
  bullet/tree_group.h
  bullet/world_attachment.h
  bullet/world_state.h
  bullet/world_tie.h
  fluid_body/added_mass_part.h
  fluid_body/cluster_block.h
  fluid_body/fluid_body.h
  fluid_body/fluid_body_file.h
  fluid_body/load_fluid_body.h
  fluid_body/load_level.h
  fluid_body/waterline_table.h
  force/airy_waves.h
  force/face_loads.h
  force/flow_settings.h
  force/fluid_region.h
  force/medium.h
  force/surface_loads.h
  force/surface_plane.h
  force/water_surface.h
  force/wave_spectrum.h
  motion/flight_memory.h
  motion/flight_settings.h
  motion/wave_memory.h
  spatial/frame_offset.h
  spatial/principal_frame.h
  spatial/spatial_vectors.h
  spatial/vector_types.h
  tasks/task_runner.h
  tasks/thread_pool.h)
set(BULLET_AMBIENT_PUBLIC_PREPROCESS_HEADERS
  builder/fluid_body_builder.h
  collision_shape/collision_shape_body.h
  collision_shape/fluid_body_cache.h
  mesh/mesh_checks.h
  mesh/mesh_defect.h
  mesh/mesh_import.h
  mesh/primitives.h
  mesh/triangle_mesh.h
  potential_flow/potential_flow.h
  robot/file_reference.h
  robot/link_shape.h
  robot/robot.h
  robot/robot_fluid.h
  robot/robot_model.h
  robot/urdf_reader.h
  shape/shape_description.h)

# The headers keep the paths they have in the source tree; those of the preprocessor move below bullet_ambient/, so
# that the include directory gets one new name.
function(ambient_install_headers source_dir destination)
  foreach(header IN LISTS ARGN)
    cmake_path(GET header PARENT_PATH folder)
    install(FILES ${source_dir}/${header} DESTINATION ${destination}/${folder})
  endforeach()
endfunction()

# find_package(BulletAmbient)
function(ambient_install_package)
  get_property(exports GLOBAL PROPERTY BULLET_AMBIENT_EXPORTS)
  list(REMOVE_DUPLICATES exports)
  foreach(export IN LISTS exports)
    install(EXPORT BulletAmbientTargets-${export} NAMESPACE BulletAmbient:: DESTINATION ${BULLET_AMBIENT_PACKAGE_DIR})
  endforeach()
  set(generated ${PROJECT_BINARY_DIR}/package)
  configure_package_config_file(${CMAKE_CURRENT_FUNCTION_LIST_DIR}/BulletAmbientConfig.cmake.in
    ${generated}/BulletAmbientConfig.cmake INSTALL_DESTINATION ${BULLET_AMBIENT_PACKAGE_DIR})
  write_basic_package_version_file(${generated}/BulletAmbientConfigVersion.cmake COMPATIBILITY SameMinorVersion)
  install(FILES ${generated}/BulletAmbientConfig.cmake ${generated}/BulletAmbientConfigVersion.cmake
    ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/BulletPrecision.cmake
    DESTINATION ${BULLET_AMBIENT_PACKAGE_DIR})
endfunction()

# pkg-config bullet_ambient, bullet_ambient-float64
function(ambient_install_pkg_config)
  get_property(core GLOBAL PROPERTY BULLET_AMBIENT_BOXES_Core)
  # A static library comes after what uses it: the reverse of the order in which the boxes were added.
  list(REVERSE core)
  foreach(precision IN LISTS BULLET_AMBIENT_PRECISIONS)
    ambient_name_for_precision(name bullet_ambient ${precision})
    get_property(boxes GLOBAL PROPERTY BULLET_AMBIENT_BOXES_${precision})
    set(pc_libraries)
    foreach(box IN LISTS boxes core)
      get_target_property(type ${box} TYPE)
      if(NOT type STREQUAL "INTERFACE_LIBRARY")
        get_target_property(output_name ${box} OUTPUT_NAME)
        string(APPEND pc_libraries " -l${output_name}")
      endif()
    endforeach()
    string(COMPARE EQUAL ${precision} float64 pc_is_float64)
    get_target_property(pc_bullet BulletAmbient::bullet-${precision} PKG_CONFIG_NAME)
    set(pc_name ${name})
    file(RELATIVE_PATH pc_prefix /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
    configure_file(${CMAKE_CURRENT_FUNCTION_LIST_DIR}/bullet_ambient.pc.in ${PROJECT_BINARY_DIR}/package/${name}.pc @ONLY)
    install(FILES ${PROJECT_BINARY_DIR}/package/${name}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
  endforeach()
endfunction()

# Call once, after all boxes are added.
function(ambient_install_all)
  ambient_install_headers(${PROJECT_SOURCE_DIR}/bullet_ambient ${CMAKE_INSTALL_INCLUDEDIR}/bullet_ambient
    ${BULLET_AMBIENT_PUBLIC_HEADERS})
  if(BULLET_AMBIENT_PREPROCESS)
    ambient_install_headers(${PROJECT_SOURCE_DIR}/preprocess ${CMAKE_INSTALL_INCLUDEDIR}/bullet_ambient/preprocess
      ${BULLET_AMBIENT_PUBLIC_PREPROCESS_HEADERS})
  endif()
  ambient_install_package()
  ambient_install_pkg_config()
  install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
endfunction()
