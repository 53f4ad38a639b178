// Functions that PyBullet looks up by name in a plugin, see
// examples/SharedMemory/b3PluginManager.cpp of Bullet.
#include <cstdio>
#include <exception>
#include <string>

#include "demos/pybullet/fluid_plugin.h"

namespace {

using namespace ambient::pybullet;

struct Plugin {
  Plugin(Server& server, Client& client) : fluid(server, client) {}
  FluidPlugin fluid;
  std::string said;
  ReturnData reply{};
};

constexpr int kText = 2;  // value of ReturnData::type

Plugin& pluginOf(const Context* context) { return *static_cast<Plugin*>(context->user_pointer); }

// Calls a function and returns the text of its exception; empty: none. Exceptions must not pass
// through PyBullet.
template <class Function>
std::string errorOf(const Function& function) {
  std::string error;
  try {
    function();
    return error;
  } catch (const std::exception& thrown) {
    error = thrown.what();
  } catch (...) {
    error = "something unknown was thrown";
  }
  std::fprintf(stderr, "bullet_ambient: %s\n", error.c_str());
  return error.empty() ? "an error without a text" : error;
}

template <class Function>
int resultOf(const Function& function) {
  return errorOf(function).empty() ? 0 : -1;
}

}  // namespace

#define EXPORTED extern "C" __attribute__((visibility("default")))

// PyBullet prescribes these names.
// NOLINTBEGIN(readability-identifier-naming)
EXPORTED int initPlugin_ambient(Context* context) {
  if (!context->server) return -1;
  const bool is_made = resultOf([&] {
                         context->user_pointer = new Plugin(*context->server, *context->client);
                       }) == 0;
  return is_made ? kApiVersion : -1;
}

EXPORTED void exitPlugin_ambient(Context* context) {
  resultOf([&] { delete &pluginOf(context); });
  context->user_pointer = nullptr;
}

EXPORTED int executePluginCommand_ambient(Context* context, const Arguments* arguments) {
  Plugin& plugin = pluginOf(context);
  std::string said;
  const std::string error = errorOf([&] { said = plugin.fluid.execute(*arguments); });
  plugin.said = error.empty() ? said : error;
  plugin.reply = {kText, static_cast<int>(plugin.said.size()), plugin.said.data()};
  context->return_data = plugin.said.empty() ? nullptr : &plugin.reply;
  return error.empty() ? 0 : -1;
}

EXPORTED int preTickPluginCallback_ambient(Context* context) {
  return resultOf([&] { pluginOf(context).fluid.beforeStep(); });
}

EXPORTED int processNotifications_ambient(Context* context) {
  return resultOf(
      [&] { pluginOf(context).fluid.notice(context->notifications, context->notification_count); });
}
// NOLINTEND(readability-identifier-naming)
