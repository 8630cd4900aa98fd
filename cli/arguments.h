// What a command may ask of its command line. Everything arrives as text: numbers and times are read by parse.h, which refuses what
// a general-purpose parser lets through (nan, 1e999, 0x10).
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace CLI {
class App;
}

namespace cli {

class Arguments {
 public:
  explicit Arguments(CLI::App& app) : app_(app) {}

  void positional(const std::string& name, std::string& target, const std::string& help);
  void positionals(const std::string& name, std::vector<std::string>& target, const std::string& help);
  void option(const std::string& names, std::string& target, const std::string& value_name, const std::string& help);
  void required_option(const std::string& names, std::string& target, const std::string& value_name, const std::string& help);
  /// May be given several times, one value each.
  void repeatable(const std::string& names, std::vector<std::string>& target, const std::string& value_name,
                  const std::string& help);
  /// May stand alone or with any number of values; says whether it was given.
  void list(const std::string& names, bool& given, std::vector<std::string>& target, const std::string& value_name,
            const std::string& help);
  void choice(const std::string& names, std::string& target, const std::vector<std::string>& choices, const std::string& help);
  void flag(const std::string& names, bool& target, const std::string& help);

  /// Every option of the command that was given, by its long name, with its values: to be asked once the command runs.
  std::vector<std::pair<std::string, std::string>> given() const;

 private:
  CLI::App& app_;
};

}  // namespace cli
