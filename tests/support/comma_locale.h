#pragma once

#include <clocale>
#include <cstdlib>
#include <locale>
#include <string>

#include "tests/support/temporary_folder.h"

namespace ambient::test {

/// Scope in which streams and the C library write decimal commas, as in Germany. Compiles the C
/// library's locale here: none needs to be installed.
class CommaLocale {
 public:
  CommaLocale() {
    std::locale::global(std::locale(std::locale::classic(), new CommaPoint));
    writeText(
        folder_ / "comma.txt",
        "LC_NUMERIC\ndecimal_point \",\"\nthousands_sep \".\"\ngrouping 3;3\nEND LC_NUMERIC\n");
    const std::string folder = folder_.path().string();
    const std::string command =
        "localedef -c -i " + folder + "/comma.txt " + folder + "/comma 2> " + folder + "/messages";
    // localedef complains of missing categories.
    static_cast<void>(std::system(command.c_str()));
    setenv("LOCPATH", folder.c_str(), 1);
    std::setlocale(LC_NUMERIC, "comma");
  }
  ~CommaLocale() {
    std::setlocale(LC_NUMERIC, "C");
    unsetenv("LOCPATH");
    std::locale::global(std::locale::classic());
  }
  CommaLocale(const CommaLocale&) = delete;
  CommaLocale& operator=(const CommaLocale&) = delete;

  /// Tells if the C library writes commas: not without localedef.
  bool rulesTheCLibrary() const { return std::strtod("0,5", nullptr) == 0.5; }

 private:
  struct CommaPoint : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
  };

  TemporaryFolder folder_;
};

}  // namespace ambient::test
