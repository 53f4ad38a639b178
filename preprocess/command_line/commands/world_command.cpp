#include <BulletCollision/CollisionShapes/btCollisionShape.h>
#include <BulletFileLoader/btBulletFile.h>
#include <BulletWorldImporter/btBulletWorldImporter.h>
#include <btBulletDynamicsCommon.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "bullet_ambient/base/plain_text.h"
#include "preprocess/base/fluid_body_writer.h"
#include "preprocess/builder/body_maker.h"
#include "preprocess/builder/elapsed_display.h"
#include "preprocess/collision_shape/collision_shape_body.h"
#include "preprocess/command_line/commands.h"
#include "preprocess/command_line/fluid_body_report.h"
#include "preprocess/command_line/option_values.h"
#include "preprocess/mesh/input_error.h"
#include "preprocess/shape/json_schema.h"

namespace ambient {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

// "BULLET", precision f or d, pointers of 4 (_) or 8 (-) bytes, little (v) or big (V) endian,
// three digits of version. Then chunks; the last one holds the DNA.
constexpr std::size_t kHeaderSize = 12;

/// Reads parts of a file one after the other.
class Reader {
 public:
  Reader(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  std::string_view take(std::size_t size, const char* what) {
    if (size > bytes_.size() - at_) raiseInputError(name_, "damaged: it ends within ", what);
    const std::string_view taken = bytes_.substr(at_, size);
    at_ += size;
    return taken;
  }

  template <class Number>
  Number number(const char* what) {
    Number value;
    std::memcpy(&value, take(sizeof value, what).data(), sizeof value);
    return value;
  }

  // A number of things that take at least `least_size` bytes each.
  std::size_t count(const char* what, std::size_t least_size) {
    const auto count = number<std::int32_t>(what);
    if (count < 0 || static_cast<std::size_t>(count) > (bytes_.size() - at_) / least_size) {
      raiseInputError(name_, "damaged: ", what, " has ", count, " entries");
    }
    return static_cast<std::size_t>(count);
  }

  void mark(std::string_view expected) {
    if (take(expected.size(), "its DNA") != expected) {
      raiseInputError(name_, "damaged: its DNA lacks the mark ", expected);
    }
  }

  void skipTexts(std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t end = bytes_.find('\0', at_);
      if (end == std::string_view::npos) raiseInputError(name_, "damaged: it ends within its DNA");
      at_ = end + 1;
    }
    align();
  }

  void align() { take((4 - at_ % 4) % 4, "its DNA"); }
  std::size_t at() const { return at_; }

 private:
  std::string_view bytes_;
  const std::string& name_;
  std::size_t at_ = 0;
};

struct Chunk {
  std::string_view code;
  std::int32_t length = 0, structure = 0, count = 0;
};

Chunk readChunk(Reader& reader, std::size_t pointer_size) {
  constexpr const char* kWhere = "the head of a chunk";
  Chunk chunk;
  chunk.code = reader.take(4, kWhere);
  chunk.length = reader.number<std::int32_t>(kWhere);
  reader.take(pointer_size, kWhere);
  chunk.structure = reader.number<std::int32_t>(kWhere);
  chunk.count = reader.number<std::int32_t>(kWhere);
  return chunk;
}

// Sizes of the structures, by number [bytes]; the indices in it are checked.
std::vector<std::size_t> readDna(Reader& reader, const std::string& name) {
  reader.mark("SDNANAME");
  const std::size_t names = reader.count("the list of names", 1);
  reader.skipTexts(names);
  reader.mark("TYPE");
  const std::size_t types = reader.count("the list of types", 1);
  reader.skipTexts(types);
  reader.mark("TLEN");
  std::vector<std::size_t> type_sizes;
  for (std::size_t i = 0; i < types; ++i) {
    type_sizes.push_back(reader.number<std::uint16_t>("its DNA"));
  }
  reader.align();
  reader.mark("STRC");
  const auto index = [&](std::size_t limit) {
    const std::size_t value = reader.number<std::uint16_t>("its DNA");
    if (value >= limit) raiseInputError(name, "damaged: its DNA refers to what it does not hold");
    return value;
  };
  std::vector<std::size_t> sizes(reader.count("the list of structures", 4));
  for (std::size_t& size : sizes) {
    size = type_sizes[index(types)];
    const std::size_t fields = reader.number<std::uint16_t>("its DNA");
    for (std::size_t i = 0; i < fields; ++i) {
      index(types);
      index(names);
    }
  }
  return sizes;
}

void checkChunk(const Chunk& chunk, const std::vector<std::size_t>& sizes,
                const std::string& name) {
  if (chunk.structure < 0) return;  // plain bytes
  const auto structure = static_cast<std::size_t>(chunk.structure);
  if (structure >= sizes.size() || chunk.count < 0 ||
      static_cast<std::size_t>(chunk.count) * sizes[structure] >
          static_cast<std::size_t>(chunk.length)) {
    raiseInputError(name, "damaged: a chunk of ", chunk.length, " bytes announces ", chunk.count,
                    " structures of kind ", chunk.structure, ", which it cannot hold");
  }
}

std::size_t checkHeader(std::string_view header, const std::string& name) {
  if (header.substr(0, 6) != "BULLET") {
    raiseInputError(name, "is not a .bullet file: it does not begin with BULLET");
  }
  if (header.size() < kHeaderSize) raiseInputError(name, "damaged: it ends within its header");
  if (header[8] == 'V') raiseInputError(name, "comes from a big-endian machine: not supported");
  if ((header[6] != 'f' && header[6] != 'd') || (header[7] != '-' && header[7] != '_') ||
      header[8] != 'v') {
    raiseInputError(name, "damaged: its header is not valid");
  }
  return header[7] == '-' ? 8 : 4;
}

/// Checks what Bullet's importer takes for granted in the bytes of a .bullet file: its header,
/// chunks that end inside the file and hold the structures that they announce, and a description
/// of those structures (DNA) that is whole. The content of the structures is not looked at.
/// @throws std::runtime_error in one line that begins with `name`.
void checkFileStructure(const std::string& bytes, const std::string& name) {
  const std::size_t pointer_size = checkHeader(bytes.substr(0, kHeaderSize), name);
  Reader reader(bytes, name);
  reader.take(kHeaderSize, "its header");
  std::vector<Chunk> chunks;
  for (;;) {
    const Chunk chunk = readChunk(reader, pointer_size);
    if (chunk.length < 0) {
      raiseInputError(name, "damaged: a chunk has a length of ", chunk.length, " bytes");
    }
    if (chunk.code == "DNA1") break;
    reader.take(static_cast<std::size_t>(chunk.length), "a chunk");
    chunks.push_back(chunk);
  }
  // Bullet takes the last of these marks for the DNA.
  if (bytes.rfind("SDNANAME") != reader.at()) {
    raiseInputError(name, "damaged: its DNA is not where it should be");
  }
  const std::vector<std::size_t> sizes = readDna(reader, name);
  for (const Chunk& chunk : chunks) checkChunk(chunk, sizes, name);
}

std::string fileNameOf(std::string text) {
  for (char& c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) == 0 && c != '-' && c != '_' && c != '.') c = '_';
  }
  // Neither hidden nor the folder itself.
  if (!text.empty() && text.front() == '.') text.front() = '_';
  return text;
}

std::string uniqueName(const std::string& wanted, std::set<std::string>& taken) {
  std::string name = wanted;
  for (int k = 2; !taken.insert(name).second; ++k) name = wanted + "_" + std::to_string(k);
  return name;
}

/// While it lives, what Bullet prints to standard output goes to standard error: the former belongs
/// to results.
class PrintedToErrors {
 public:
  PrintedToErrors() {
    std::fflush(stdout);
    output_ = ::dup(STDOUT_FILENO);
    ::dup2(STDERR_FILENO, STDOUT_FILENO);
  }
  ~PrintedToErrors() {
    std::fflush(stdout);
    ::dup2(output_, STDOUT_FILENO);
    ::close(output_);
  }
  PrintedToErrors(const PrintedToErrors&) = delete;
  PrintedToErrors& operator=(const PrintedToErrors&) = delete;

 private:
  int output_ = -1;
};

/// A parsed file that knows which pointers Bullet could resolve.
class ParsedFile : public bParse::btBulletFile {
 public:
  using btBulletFile::btBulletFile;

  bool holds(const void* address) {
    for (int i = 0; i < mLibPointers.size(); ++i) {
      if (*mLibPointers.getAtIndex(i) == address) return true;
    }
    return false;
  }
};

// Bullet writes no chunk for the name "", and the importer reads the name where there is nothing.
template <class Data, class Name>
void dropLostNames(btAlignedObjectArray<bParse::bStructHandle*>& objects, ParsedFile& file,
                   const Name& name) {
  for (int i = 0; i < objects.size(); ++i) {
    if (objects[i] == nullptr) continue;
    char*& text = name(*reinterpret_cast<Data*>(objects[i]));
    if (!file.holds(text)) text = nullptr;
  }
}

// The structures of objects are those of the file's precision.
void dropLostNames(ParsedFile& file) {
  const auto body_name = [](auto& body) -> char*& { return body.m_collisionObjectData.m_name; };
  const auto own_name = [](auto& data) -> char*& { return data.m_name; };
  if ((file.getFlags() & bParse::FD_DOUBLE_PRECISION) != 0) {
    dropLostNames<btRigidBodyDoubleData>(file.m_rigidBodies, file, body_name);
    dropLostNames<btCollisionObjectDoubleData>(file.m_collisionObjects, file, own_name);
  } else {
    dropLostNames<btRigidBodyFloatData>(file.m_rigidBodies, file, body_name);
    dropLostNames<btCollisionObjectFloatData>(file.m_collisionObjects, file, own_name);
  }
  dropLostNames<btCollisionShapeData>(file.m_collisionShapes, file, own_name);
}

struct WorldImporter : btBulletWorldImporter {
  ~WorldImporter() override { deleteAllData(); }

  bool convertAllObjects(bParse::btBulletFile* file) override {
    dropLostNames(static_cast<ParsedFile&>(*file));
    return btBulletWorldImporter::convertAllObjects(file);
  }

  std::string nameOf(const void* object) const {
    const char* name = getNameForPointer(object);
    return name != nullptr ? name : "";
  }
};

/// A collision shape of a world, and the dynamic bodies with this shape.
struct WorldShape {
  std::string name;  ///< unique in the file, fit for a file name
  const btCollisionShape* shape = nullptr;
  std::vector<std::string> bodies;  ///< names; "body <number>" for those without
};

/// The content of a .bullet file, as btDynamicsWorld::serialize() writes it, in either precision.
/// Header, chunks and the description of structures are checked; what the structures hold is
/// followed without checks, as Bullet does: read files that you trust.
struct WorldFile {
  /// @throws std::runtime_error in one line that names the file, if it cannot be read, is not a
  /// .bullet file or a damaged one, or Bullet refuses it.
  explicit WorldFile(const fs::path& file);

  WorldImporter importer;
  /// Distinct shapes of bodies with mass, in the order of the bodies. A shape is named after its
  /// body if there is only one, else by its own name, else after its first body.
  std::vector<WorldShape> shapes;
  int lost_bodies = 0;  ///< that Bullet's importer left out because it does not know their shape
  int multibodies = 0;  ///< bodies of joints that Bullet's importer does not read
};

WorldFile::WorldFile(const fs::path& file) {
  std::string bytes = readBytes(file);
  checkFileStructure(bytes, file.string());
  {
    const PrintedToErrors while_loading;
    ParsedFile parsed(bytes.data(), static_cast<int>(bytes.size()));
    if (!importer.loadFileFromMemory(&parsed)) {
      raiseInputError(file.string(), "Bullet cannot read it");
    }
    lost_bodies = parsed.m_rigidBodies.size() - importer.getNumRigidBodies();
    multibodies = parsed.m_multiBodies.size();
  }
  for (int i = 0; i < importer.getNumRigidBodies(); ++i) {
    const btRigidBody* body = btRigidBody::upcast(importer.getRigidBodyByIndex(i));
    if (body == nullptr || !(body->getInvMass() > 0)) continue;
    const btCollisionShape* shape = body->getCollisionShape();
    auto known = std::find_if(shapes.begin(), shapes.end(),
                              [&](const WorldShape& s) { return s.shape == shape; });
    if (known == shapes.end()) known = shapes.insert(known, {"", shape, {}});
    const std::string name = importer.nameOf(body);
    known->bodies.push_back(name.empty() ? "body " + std::to_string(i) : name);
  }
  std::set<std::string> taken;
  for (WorldShape& shape : shapes) {
    const std::string own = importer.nameOf(shape.shape);
    const bool is_shared = shape.bodies.size() > 1 && !own.empty();
    shape.name = uniqueName(fileNameOf(is_shared ? own : shape.bodies.front()), taken);
  }
}

void requireWorldOptions(const BuildArguments& arguments) {
  const auto refuse = [](const char* option) {
    raiseUsageError(option, "has no meaning for a world: its shapes keep frame and size");
  };
  const auto refuseForMany = [](const char* option) {
    raiseUsageError(option, "is for one mesh, not for a world");
  };
  if (arguments.options.scale != 1) refuse("--scale");
  if (arguments.origin != "centre-of-volume") refuse("--origin");
  if (arguments.options.sheet) refuse("--sheet");
  if (arguments.options.hull) refuseForMany("--hull");
  if (arguments.options.wrap) refuseForMany("--wrap");
  if (!arguments.options.up.empty()) refuseForMany("--up");
  if (arguments.least_faces != 0) refuse("--least-faces");
  if (!arguments.levels.empty()) refuseForMany("--levels");
  if (arguments.waterline != 0) refuseForMany("--waterline-table");
}

void requireFolder(const fs::path& output) {
  std::error_code error;
  if (fs::exists(output, error) && !fs::is_directory(output, error)) {
    raiseInputError(output.string(), "is a file; the output of a world is a folder");
  }
}

CollisionShapeSettings shapeSettingsOf(const BuildArguments& arguments) {
  if (!arguments.tanks.empty() || !arguments.openings.empty())
    raiseUsageError(arguments.tanks.empty() ? "--opening" : "--tank", "a world has no use for it");
  CollisionShapeSettings settings;
  settings.flow.max_panels = arguments.panels;
  settings.flow.threads = arguments.threads;
  settings.tables = !arguments.no_tables;
  settings.holds = holdsOf(arguments.options).is_wanted;
  settings.strict = arguments.options.strict;
  return settings;
}

/// Makes folder/<name>.ambient of a shape, or keeps it if it is still right. Prints warnings and
/// failures to standard error, one line each that begins with the input; a shape that fails leaves
/// its file as it was.
ordered_json buildShapeFile(const WorldShape& shape, CollisionShapeSettings settings,
                            const BuildArguments& arguments) {
  const auto start = std::chrono::steady_clock::now();
  const fs::path file = fs::path(arguments.output) / (shape.name + ".ambient");
  std::optional<FluidBody> kept, body;
  std::string failure;
  settings.name = shape.name;
  settings.report = nullptr;
  try {
    const ElapsedDisplay display("building " + shape.name);
    const Provenance provenance = describeCollisionShape(*shape.shape, settings);
    if (!arguments.rebuild) kept = readIfSame(file, shape.name, provenance);
    body = kept ? kept : makeFluidBody(*shape.shape, settings);
    if (!kept) writeFluidBody(*body, file);
  } catch (const std::exception& error) {
    failure = error.what();
  }
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  const std::string input = plainLine(arguments.input) + ": ";
  if (body)
    for (const std::string& warning : body->provenance.said)
      std::cerr << "warning: " << input << plainLine(warning) << "\n";
  if (!failure.empty()) std::cerr << input << plainLine(failure) << "\n";
  ordered_json facts{{"name", shape.name},
                     {"file", file.string()},
                     {"status", !failure.empty() ? "failed"
                                : kept           ? "kept"
                                                 : "built"},
                     {"bodies", shape.bodies},
                     {"seconds", seconds.count()}};
  if (!failure.empty()) {
    facts["message"] = failure;
  } else {
    facts["faces"] = body->faces.size();
    facts["size"] = vectorJson(extentsOf(*body));
    facts["volume"] = body->volume;
  }
  return facts;
}

/// Prints what a world has besides shapes to standard error.
void printLost(const WorldFile& world, const std::string& input) {
  if (world.lost_bodies > 0) {
    std::cerr << input << ": " << world.lost_bodies
              << " bodies were left out: Bullet's importer does not know their shape\n";
  }
  if (world.multibodies > 0) {
    std::cerr
        << input << ": " << world.multibodies
        << " multibodies were left out: makeFluidBody makes the fluid bodies of their links\n";
  } else if (world.shapes.empty()) {
    std::cerr << "warning: " << input << ": no body has mass\n";
  }
}

}  // namespace

int buildWorldFile(const BuildArguments& arguments) {
  requireWorldOptions(arguments);
  const CollisionShapeSettings settings = shapeSettingsOf(arguments);
  requireRegularFile(arguments.input, ".bullet");
  requireFolder(arguments.output);
  const WorldFile world(arguments.input);
  std::error_code no_folder;
  fs::create_directories(arguments.output, no_folder);
  if (no_folder)
    raiseInputError(arguments.output, "the folder cannot be made: ", no_folder.message());
  ordered_json shapes = ordered_json::array();
  int failed = 0;
  for (const WorldShape& shape : world.shapes) {
    shapes.push_back(buildShapeFile(shape, settings, arguments));
    failed += shapes.back()["status"] == "failed" ? 1 : 0;
  }
  printLost(world, plainLine(arguments.input));
  std::cout << factsText({{"shapes", shapes},
                          {"failed", failed},
                          {"lost_bodies", world.lost_bodies},
                          {"lost_multibodies", world.multibodies}},
                         arguments.json);
  return failed > 0 || world.lost_bodies > 0 || world.multibodies > 0 ? 1 : 0;
}

}  // namespace ambient
