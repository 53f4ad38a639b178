# What `cmake --install` puts where. One export set for each thing a program may use without the others:
#   Core                   the boxes without Bullet
#   float32, float64       the runtime for one precision of Bullet
#   Preprocess             the offline library, Preprocess_float32/_float64 what of it includes Bullet
# so that a program for one precision does not need the Bullet of the other.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(BULLET_AMBIENT_PACKAGE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/BulletAmbient)
set(BULLET_AMBIENT_DETAIL_DIR ${CMAKE_INSTALL_INCLUDEDIR}/bullet_ambient/detail)

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
    INCLUDES DESTINATION ${include_dir} ${BULLET_AMBIENT_DETAIL_DIR})
endfunction()

# The public headers stand in bullet_ambient/ and preprocess/ themselves. What they include is installed below
# bullet_ambient/detail, under the paths of the source tree, and free to change; headers that no public one needs are not.
function(ambient_install_headers folder destination)
  install(CODE "
    set(source \"${PROJECT_SOURCE_DIR}\")
    set(folder \"${folder}\")
    set(destination \"\${CMAKE_INSTALL_PREFIX}/${destination}\")
    set(details \"\${CMAKE_INSTALL_PREFIX}/${BULLET_AMBIENT_DETAIL_DIR}\")
    include(\"${CMAKE_CURRENT_FUNCTION_LIST_DIR}/InstallHeaders.cmake\")")
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
  ambient_install_headers(bullet_ambient ${CMAKE_INSTALL_INCLUDEDIR}/bullet_ambient)
  if(BULLET_AMBIENT_PREPROCESS)
    ambient_install_headers(preprocess ${CMAKE_INSTALL_INCLUDEDIR}/bullet_ambient/preprocess)
  endif()
  ambient_install_package()
  ambient_install_pkg_config()
  install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
endfunction()
