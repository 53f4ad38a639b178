# An overlay port: it builds the tree that it stands in.
get_filename_component(SOURCE_PATH "${CMAKE_CURRENT_LIST_DIR}/../../../../.." ABSOLUTE)

vcpkg_check_features(OUT_FEATURE_OPTIONS FEATURE_OPTIONS
    FEATURES
        double-precision  BULLET_AMBIENT_FLOAT64
        preprocess        BULLET_AMBIENT_PREPROCESS
    INVERTED_FEATURES
        double-precision  BULLET_AMBIENT_FLOAT32
)
vcpkg_cmake_configure(
    SOURCE_PATH "${SOURCE_PATH}"
    OPTIONS
        ${FEATURE_OPTIONS}
        -DBULLET_AMBIENT_DEMOS=OFF
        -DBULLET_AMBIENT_TESTS=OFF
        -DCMAKE_UNITY_BUILD=ON
        -DCMAKE_UNITY_BUILD_BATCH_SIZE=0
)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(PACKAGE_NAME BulletAmbient CONFIG_PATH lib/cmake/BulletAmbient)
vcpkg_fixup_pkgconfig()
if("preprocess" IN_LIST FEATURES)
    vcpkg_copy_tools(TOOL_NAMES ambient_preprocess ambient_mesh_reader AUTO_CLEAN)
endif()

file(REMOVE_RECURSE
    "${CURRENT_PACKAGES_DIR}/debug/include"
    "${CURRENT_PACKAGES_DIR}/debug/share"
    "${CURRENT_PACKAGES_DIR}/share/doc")
file(INSTALL "${CMAKE_CURRENT_LIST_DIR}/usage" DESTINATION "${CURRENT_PACKAGES_DIR}/share/${PORT}")
vcpkg_install_copyright(FILE_LIST "${SOURCE_PATH}/LICENSE")
