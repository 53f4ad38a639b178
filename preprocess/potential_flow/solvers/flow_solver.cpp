#include "preprocess/potential_flow/solvers/flow_solver.h"

#include <unistd.h>

#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>

namespace ambient {

double memoryLimit(double setting) {
  if (setting > 0) return setting;
  // Reads the memory that Linux can give without swapping; elsewhere all that is installed counts.
  std::ifstream info("/proc/meminfo");
  std::string key;
  for (double kilobytes = 0; info >> key >> kilobytes;
       info.ignore(std::numeric_limits<std::streamsize>::max(), '\n'))
    if (key == "MemAvailable:") return 1024 * kilobytes;
  const double pages = static_cast<double>(::sysconf(_SC_PHYS_PAGES));
  return pages > 0 ? pages * static_cast<double>(::sysconf(_SC_PAGESIZE))
                   : std::numeric_limits<double>::infinity();
}

void requireMemory(Eigen::Index panels, double bytes, double limit) {
  if (bytes <= limit) return;
  std::ostringstream message;
  message.precision(2);
  message << "potential flow: " << panels << " panels need " << bytes / 1e9
          << " GB of memory, more than the " << limit / 1e9
          << " GB that may be used: use fewer panels or allow more memory";
  throw std::runtime_error(message.str());
}

void raiseOutOfMemory(Eigen::Index panels, double bytes) {
  std::ostringstream message;
  message.precision(2);
  message << "potential flow: " << panels << " panels need ";
  if (bytes > 0) {
    message << bytes / 1e9 << " GB of memory, which is not there: use fewer panels";
  } else {
    message << "more memory than there is: use fewer panels";
  }
  throw std::runtime_error(message.str());
}

}  // namespace ambient
