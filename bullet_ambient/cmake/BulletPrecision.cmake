# bullet_ambient_find_bullet(float32|float64 [REQUIRED]): makes the imported target BulletAmbient::bullet-float32
# or BulletAmbient::bullet-float64 from the first BulletConfig*.cmake on CMake's search path of that precision.
#
# Bullet's own package config gives variables, not targets, and on Debian 12 its include path is relative and one of
# the libraries it names is not shipped; vcpkg's and Conan's name targets where Bullet's has libraries. Its precision is
# known from BULLET_DEFINITIONS alone.
# Bullet_float32_DIR and Bullet_float64_DIR override the search, as <Package>_DIR does.
set(BULLET_AMBIENT_BULLET_ROOT "" CACHE PATH "Prefix of the Bullet to use; empty: the first on CMake's search path")

# Relative paths of Bullet's config hang below its root directory or, if the install was moved, below its prefix.
function(_bullet_ambient_absolute_dirs out config_dir root)
  set(absolute)
  foreach(dir IN LISTS ARGN)
    if(NOT IS_ABSOLUTE "${dir}")
      if(NOT EXISTS "${root}/${dir}")
        string(REGEX REPLACE "/(lib|lib32|lib64|share)/.*$" "" root "${config_dir}")
      endif()
      set(dir "${root}/${dir}")
    endif()
    list(APPEND absolute "${dir}")
  endforeach()
  set(${out} "${absolute}" PARENT_SCOPE)
endfunction()

# The file, or else the target, of one of Bullet's libraries.
function(_bullet_ambient_find_part out part config_dir)
  set(names ${BULLET_LIBRARIES})
  if(NOT TARGET "${names}")  # else one target for all of them
    list(FILTER names INCLUDE REGEX "^${part}")
  endif()
  unset(library)
  find_library(library NAMES ${names} PATHS ${ARGN} NO_DEFAULT_PATH NO_CACHE)
  foreach(target IN LISTS names)
    if(NOT library AND TARGET "${target}")
      set(library "${target}")
    endif()
  endforeach()
  if(NOT library)
    message(FATAL_ERROR "bullet_ambient: Bullet's config in ${config_dir} names the library '${names}', but it is not in ${ARGN}")
  endif()
  set(${out} "${library}" PARENT_SCOPE)
endfunction()

# Runs inside a function, so that the config's variables do not leak.
function(_bullet_ambient_make_target precision config_dir)
  _bullet_ambient_absolute_dirs(includes "${config_dir}" "${BULLET_ROOT_DIR}" ${BULLET_INCLUDE_DIRS})
  _bullet_ambient_absolute_dirs(library_dirs "${config_dir}" "${BULLET_ROOT_DIR}" ${BULLET_LIBRARY_DIRS})
  set(libraries)
  # The order matters for static libraries.
  foreach(part BulletSoftBody BulletDynamics BulletCollision LinearMath)
    _bullet_ambient_find_part(library ${part} "${config_dir}" ${library_dirs})
    list(APPEND libraries "${library}")
  endforeach()
  list(REMOVE_DUPLICATES libraries)
  # Debian has one pkg-config file per precision, upstream one of the same name for either.
  set(pkg_config_name bullet)
  foreach(dir IN LISTS library_dirs)
    if(precision STREQUAL "float64" AND EXISTS "${dir}/pkgconfig/bullet-float64.pc")
      set(pkg_config_name bullet-float64)
    endif()
  endforeach()
  set(target BulletAmbient::bullet-${precision})
  add_library(${target} INTERFACE IMPORTED GLOBAL)
  set_target_properties(${target} PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES "${includes}"
    INTERFACE_LINK_LIBRARIES "${libraries}"
    PKG_CONFIG_NAME ${pkg_config_name})
  separate_arguments(definitions UNIX_COMMAND "${BULLET_DEFINITIONS}")
  list(TRANSFORM definitions PREPEND "-D" REGEX "^[^-]")  # Conan's are names alone
  target_compile_options(${target} INTERFACE ${definitions})
endfunction()

function(bullet_ambient_find_bullet precision)
  if(TARGET BulletAmbient::bullet-${precision})
    return()
  endif()
  set(package Bullet_${precision})
  set(configs BulletConfig.cmake bullet-config.cmake)
  if(precision STREQUAL "float64")
    list(PREPEND configs BulletConfig-float64.cmake)
  endif()
  set(where)
  if(BULLET_AMBIENT_BULLET_ROOT)
    set(where PATHS ${BULLET_AMBIENT_BULLET_ROOT} NO_DEFAULT_PATH)
  endif()
  set(seen)
  foreach(attempt RANGE 9)
    find_package(${package} QUIET CONFIG NAMES Bullet CONFIGS ${configs} ${where})
    if(NOT ${package}_FOUND)
      break()
    endif()
    set(found float32)
    if("${BULLET_DEFINITIONS}" MATCHES "BT_USE_DOUBLE_PRECISION")
      set(found float64)
    endif()
    if(found STREQUAL precision)
      if(DEFINED BULLET_VERSION_STRING AND BULLET_VERSION_STRING VERSION_LESS 3.17)
        message(FATAL_ERROR "bullet_ambient: Bullet ${BULLET_VERSION_STRING} in ${${package}_DIR} is too old; 3.17 is the "
          "first whose solvers have all that is overridden.")
      endif()
      _bullet_ambient_make_target(${precision} "${${package}_DIR}")
      return()
    endif()
    # The other precision: look past this directory.
    list(APPEND seen "${${package}_CONFIG} (${found})")
    list(APPEND CMAKE_IGNORE_PATH "${${package}_DIR}")
    unset(${package}_DIR CACHE)
    unset(${package}_DIR)
  endforeach()
  if("REQUIRED" IN_LIST ARGN)
    list(JOIN seen ", " seen)
    message(FATAL_ERROR "bullet_ambient: no Bullet of precision ${precision} was found (seen: ${seen}). Install it "
      "(Debian: libbullet-dev), add its prefix to CMAKE_PREFIX_PATH, or build without this precision "
      "(-DBULLET_AMBIENT_FLOAT32=OFF or -DBULLET_AMBIENT_FLOAT64=OFF).")
  endif()
endfunction()
