# Bullet's loader of .bullet files, in its extras (Debian: libbullet-extras-dev): the target bullet_world_importer-<precision> if
# it is installed.
function(ambient_find_world_importer precision)
  ambient_name_for_precision(importer BulletWorldImporter ${precision})
  ambient_name_for_precision(loader BulletFileLoader ${precision})
  get_target_property(includes BulletAmbient::bullet-${precision} INTERFACE_INCLUDE_DIRECTORIES)
  find_path(BULLET_WORLD_IMPORTER_INCLUDE BulletWorldImporter/btBulletWorldImporter.h HINTS ${includes})
  find_library(BULLET_WORLD_IMPORTER_${precision} ${importer})
  find_library(BULLET_FILE_LOADER_${precision} ${loader})
  mark_as_advanced(BULLET_WORLD_IMPORTER_INCLUDE BULLET_WORLD_IMPORTER_${precision} BULLET_FILE_LOADER_${precision})
  if(BULLET_WORLD_IMPORTER_INCLUDE AND BULLET_WORLD_IMPORTER_${precision} AND BULLET_FILE_LOADER_${precision})
    add_library(bullet_world_importer-${precision} INTERFACE)
    target_include_directories(bullet_world_importer-${precision} SYSTEM INTERFACE ${BULLET_WORLD_IMPORTER_INCLUDE})
    target_link_libraries(bullet_world_importer-${precision} INTERFACE
      ${BULLET_WORLD_IMPORTER_${precision}} ${BULLET_FILE_LOADER_${precision}})
  endif()
endfunction()
