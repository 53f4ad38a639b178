"""The Conan 2 recipe. It builds the tree that it stands in: `conan create bullet_ambient/cmake/ports/conan --build=missing`."""

import os

from conan import ConanFile
from conan.errors import ConanInvalidConfiguration
from conan.tools.build import check_min_cppstd
from conan.tools.cmake import CMake, CMakeDeps, CMakeToolchain, cmake_layout
from conan.tools.files import copy, load, rmdir

required_conan_version = ">=2.0"


class BulletAmbient(ConanFile):
    name = "bullet_ambient"
    description = "Ambient fluid (added mass, pressure, friction, buoyancy) for rigid bodies and multibodies in Bullet"
    license = "Zlib"
    topics = ("physics", "bullet", "fluid", "added mass", "buoyancy")
    package_type = "library"
    settings = "os", "arch", "compiler", "build_type"
    options = {"shared": [True, False], "fPIC": [True, False], "double_precision": [True, False], "preprocess": [True, False]}
    default_options = {"shared": False, "fPIC": True, "double_precision": False, "preprocess": False}

    def _root(self):
        """The tree: five folders above the port in a clone, the export folder otherwise."""
        return os.path.join(self.recipe_folder, *[os.pardir] * 4)

    def set_version(self):
        text = load(self, os.path.join(self._root(), "CMakeLists.txt"))
        self.version = text.split("project(BulletAmbient VERSION ")[1].split()[0]

    def export_sources(self):
        for part in ("CMakeLists.txt", "LICENSE", "bullet_ambient/*", "preprocess/*"):
            copy(self, part, self._root(), self.export_sources_folder)

    def configure(self):
        if self.options.shared:
            self.options.rm_safe("fPIC")
        self.options["bullet3"].double_precision = self.options.double_precision

    def layout(self):
        cmake_layout(self)

    def requirements(self):
        self.requires("bullet3/[>=3.17 <4]", transitive_headers=True, transitive_libs=True)
        self.requires("eigen/[>=3.4 <4]", transitive_headers=True)
        self.requires("flatbuffers/[>=22 <26]", libs=False)
        if self.options.preprocess:
            self.requires("assimp/[>=5.2 <7]", libs=False)
            self.requires("cli11/[>=2.1 <3]", libs=False)
            self.requires("nlohmann_json/[>=3.11 <4]", libs=False)

    def build_requirements(self):
        self.tool_requires("flatbuffers/<host_version>")
        self.tool_requires("cmake/[>=3.25 <5]")

    def validate(self):
        check_min_cppstd(self, 17)
        if self.settings.os != "Linux" or self.settings.arch != "x86_64":
            raise ConanInvalidConfiguration("bullet_ambient is for Linux on x86_64")

    def generate(self):
        CMakeDeps(self).generate()
        toolchain = CMakeToolchain(self)
        precision = bool(self.options.double_precision)
        toolchain.cache_variables.update({
            "BULLET_AMBIENT_FLOAT32": not precision,
            "BULLET_AMBIENT_FLOAT64": precision,
            "BULLET_AMBIENT_PREPROCESS": bool(self.options.preprocess),
            "BULLET_AMBIENT_DEMOS": False,
            "BULLET_AMBIENT_TESTS": False,
            "CMAKE_UNITY_BUILD": True,
            "CMAKE_UNITY_BUILD_BATCH_SIZE": "0",
        })
        toolchain.generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        CMake(self).install()
        copy(self, "LICENSE", self.source_folder, os.path.join(self.package_folder, "licenses"))
        rmdir(self, os.path.join(self.package_folder, "share", "doc"))

    def package_info(self):
        """Programs find the package's own config, which knows its targets and finds Bullet and Eigen."""
        self.cpp_info.set_property("cmake_find_mode", "none")
        self.cpp_info.builddirs = [os.path.join("lib", "cmake", "BulletAmbient")]
