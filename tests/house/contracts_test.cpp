// The contracts of the public interface: a function's comment states its errors, and the memory of its result; clauses
// stand in one order; each header states its threads; the version has one value.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <regex>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "house/tree.h"
#include "tessera/version.h"

namespace tessera::house { namespace {

// Functions that make the Status of an error which the caller has found.
const std::vector<std::string> error_makers{"in_surface", "expected", "failure", "refused_element"};

struct PublicFunction {
  std::string name;
  std::string comment;  // of the declaration, or of the overload above it
};

constexpr const char* fallible = "Status|Result<.*>";
constexpr const char* allocating = "std::vector<.*>|std::string";

/// The functions outside of private parts that return one of these types, without friends and deleted ones.
std::vector<PublicFunction> functions_that_return(const std::string& types, const std::string& text) {
  const std::regex declaration(R"(^ *(?:static |inline |virtual )*(?:)" + types + R"() (\w+)\(.*$)");
  std::vector<PublicFunction> functions;
  std::istringstream stream(text);
  std::string comment, made_of;
  bool is_private = false, in_declaration = false, ends_comment = false;
  for (std::string line; std::getline(stream, line);) {
    std::smatch found;
    if (line == " private:") is_private = true;
    if (line == "};") is_private = false;
    const std::size_t begin = line.find_first_not_of(' ');
    if (begin != std::string::npos && line.compare(begin, 2, "//") == 0) {
      if (ends_comment) comment.clear();
      ends_comment = false;
      comment += line.substr(begin) + ' ';
      continue;
    }
    if (begin == std::string::npos) {
      comment.clear();
    } else if (std::regex_match(line, found, declaration) && !is_private) {
      functions.push_back({found[1], comment});
      in_declaration = true;
    } else if (!in_declaration && line.compare(begin, 8, "template") != 0) {
      comment.clear();
    }
    if (in_declaration && line.find("= delete") != std::string::npos) functions.pop_back();
    if (begin != std::string::npos && (line.ends_with(';') || line.ends_with('}')))
      ends_comment = true, in_declaration = false;
  }
  return functions;
}

bool states_errors(const PublicFunction& function) {
  for (const std::string& maker : error_makers)
    if (function.name == maker) return true;
  return std::regex_search(function.comment, std::regex("Errors[:,]"));
}

bool states_memory(const PublicFunction& function) { return function.comment.find("Memory: ") != std::string::npos; }

bool states_exception(const PublicFunction& function) {
  return function.name == "take_patches" ||  // moves
         std::regex_search(function.comment, std::regex("throws (/// )?std::bad_alloc"));
}

TEST(Contracts, SearchForFalliblePublicFunctionsFindsThem) {
  const auto found = functions_that_return(fallible, R"(
/// Makes it. Errors: none.
Result<int> make(int a,
                 int b);
Result<int> make(double a);
/// Says nothing.
Status run() const;
/// Gone.
static Result<A> make(A&&) = delete;

class B {
 public:
  template <class T>
  static Result<std::pair<T, T>> pair(T t);
 private:
  Status hidden();
};
)");
  ASSERT_EQ(found.size(), 4u);
  EXPECT_TRUE(states_errors(found[0]));
  EXPECT_TRUE(states_errors(found[1]));
  EXPECT_EQ(found[2].name, "run");
  EXPECT_FALSE(states_errors(found[2]));
  EXPECT_EQ(found[3].name, "pair");
  EXPECT_FALSE(states_errors(found[3]));
}

TEST(Contracts, FunctionsThatMayFailStateTheirErrors) {
  std::size_t checked = 0;
  for (const std::string& path : files_under("engine/include/tessera")) {
    if (path.find("/detail/") != std::string::npos || path.ends_with("/status.h") || path.ends_with("/guard.h"))
      continue;
    for (const PublicFunction& function : functions_that_return(fallible, read_text(path))) {
      ++checked;
      EXPECT_TRUE(states_errors(function)) << path << ": " << function.name << "() does not say \"Errors: ...\"";
    }
  }
  EXPECT_GT(checked, 150u) << "the search finds too few functions";
}

TEST(Contracts, SearchForFunctionsThatAllocateFindsThem) {
  const auto found = functions_that_return(allocating, R"(
/// Makes it. Errors: none; throws std::bad_alloc if memory runs out. Memory: the result.
std::vector<double> make(int count);
class B {
 public:
  /// Its name.
  std::string name() const { return {}; }
  /// A view. Memory: none.
  std::string_view view() const;
  /// Takes it.
  std::vector<std::pair<int, int>> take() && { return {}; }
};
)");
  ASSERT_EQ(found.size(), 3u);
  EXPECT_TRUE(states_errors(found[0]) && states_memory(found[0]) && states_exception(found[0]));
  EXPECT_EQ(found[1].name, "name");
  EXPECT_FALSE(states_errors(found[1]) || states_memory(found[1]) || states_exception(found[1]));
  EXPECT_EQ(found[2].name, "take");
  EXPECT_FALSE(states_errors(found[2]) || states_memory(found[2]));
}

TEST(Contracts, FunctionsThatReturnMemoryStateItAndTheirErrors) {
  std::size_t checked = 0;
  for (const std::string& path : files_under("engine/include/tessera")) {
    if (path.find("/detail/") != std::string::npos) continue;
    for (const PublicFunction& function : functions_that_return(allocating, read_text(path))) {
      ++checked;
      EXPECT_TRUE(states_errors(function) && states_memory(function))
          << path << ": " << function.name << "() does not say \"Errors: ... Memory: ...\"";
      EXPECT_TRUE(states_exception(function)) << path << ": " << function.name << "() does not say that it may throw";
    }
  }
  EXPECT_GE(checked, 3u) << "the search finds too few functions";
}

/// The clauses of a contract in their order. A clause is found by its first word.
const std::vector<std::pair<std::string, std::regex>> clauses{
    {"errors", std::regex("\\bErrors[,:]")},
    {"memory or threads", std::regex("\\b(Memory|Threads)[,:]|\\bMemory beyond|\\bMemory and t")},
    {"source", std::regex("\\bSource:")}};

/// Names the clause that stands too early in a comment; nothing if all are in order.
std::string disorder(const std::string& comment) {
  std::ptrdiff_t last = -1;
  std::string before;
  for (const auto& [name, begins] : clauses) {
    const std::sregex_iterator first(comment.begin(), comment.end(), begins), end;
    for (auto found = first; found != end; ++found) {
      if (found == first && found->position() < last) return name + " after " + before;
      if (found->position() > last) last = found->position(), before = name;
    }
  }
  // A book or a paper in brackets is a source, too.
  static const std::regex citation("\\([^()]*(\\bch\\.|\\bsec\\.|\\beq\\.|\\bed\\.|\\b(19|20)\\d\\d)[^()]*\\)");
  std::smatch cited, errors;
  if (std::regex_search(comment, cited, citation) && std::regex_search(comment, errors, clauses[0].second) &&
      cited.position() < errors.position())
    return "errors after the source " + cited.str();
  return {};
}

/// Calls use(line, comment) for each comment of a declaration, its lines joined.
template <class Use>
void for_each_comment(const std::string& text, Use use) {
  std::istringstream stream(text);
  std::string comment;
  int number = 0, first = 0;
  for (std::string line; std::getline(stream, line);) {
    ++number;
    const std::size_t begin = line.find_first_not_of(' ');
    const bool belongs =
        begin != std::string::npos && line.compare(begin, 3, "///") == 0 && line.compare(begin, 4, "///<") != 0;
    if (belongs && comment.empty()) first = number;
    if (belongs) comment += line.substr(std::min(begin + 3, line.size())) + ' ';
    if (!belongs && !comment.empty()) use(first, std::exchange(comment, {}));
  }
}

TEST(Contracts, SearchForDisorderFindsIt) {
  EXPECT_EQ(disorder("Makes it. Errors: none. Memory: none. Threads: any. Source: Farin."), "");
  EXPECT_EQ(disorder("Makes it. Errors, with nothing written: stale. Errors that leave some: cancelled."), "");
  EXPECT_EQ(disorder("Makes it. Memory: none. Errors: none."), "memory or threads after errors");
  EXPECT_EQ(disorder("Threads: any. Errors: none."), "memory or threads after errors");
  EXPECT_EQ(disorder("Source: Farin. Threads: any."), "source after memory or threads");
  EXPECT_EQ(disorder("Source: Farin. Errors: none."), "source after errors");
  EXPECT_EQ(disorder("Makes it (Farin, 5th ed., ch. 15). Errors: none."),
            "errors after the source (Farin, 5th ed., ch. 15)");
  std::vector<std::pair<int, std::string>> found;
  for_each_comment("// No.\n/// One\n///\n/// two.\nint a;  ///< No.\n  /// Three.\n  int b;\n",
                   [&](int line, const std::string& comment) { found.emplace_back(line, comment); });
  EXPECT_EQ(found, (std::vector<std::pair<int, std::string>>{{2, " One   two. "}, {6, " Three. "}}));
}

TEST(Contracts, ClausesStandInTheirOrder) {
  std::size_t checked = 0;
  for (const std::string& path : files_under("engine/include/tessera"))
    for_each_comment(read_text(path), [&](int line, const std::string& comment) {
      ++checked;
      EXPECT_EQ(disorder(comment), "") << path << ":" << line;
    });
  EXPECT_GT(checked, 500u) << "the search finds too few comments";
}

TEST(Contracts, HeadersStateTheirThreads) {
  std::size_t checked = 0;
  for (const std::string& path : files_under("engine/include/tessera")) {
    const std::string text = read_text(path);
    if (path.find("/detail/") != std::string::npos || functions_that_return(fallible, text).empty()) continue;
    ++checked;
    EXPECT_NE(text.find("Threads: "), std::string::npos) << path;
  }
  EXPECT_GT(checked, 15u) << "the search finds too few headers";
}

TEST(Version, HasOneValue) {
  const std::string numbers[] = {std::to_string(TESSERA_VERSION_MAJOR), std::to_string(TESSERA_VERSION_MINOR),
                                 std::to_string(TESSERA_VERSION_PATCH)};
  EXPECT_EQ(TESSERA_VERSION, numbers[0] + "." + numbers[1] + "." + numbers[2]);
  EXPECT_EQ(TESSERA_VERSION_NUMBER,
            10000 * std::stoi(numbers[0]) + 100 * std::stoi(numbers[1]) + std::stoi(numbers[2]));
  const std::string name = "abi_" + numbers[0] + "_" + numbers[1];
  std::size_t checked = 0;
  for (const char* folder : {"engine/include", "engine/src"}) {
    for (const std::string& path : files_under(folder)) {
      const std::string text = read_text(path);
      static const std::regex abi(R"(\babi_\d+_\d+\b)");
      for (auto found = std::sregex_iterator(text.begin(), text.end(), abi); found != std::sregex_iterator(); ++found) {
        ++checked;
        ASSERT_EQ(found->str(), name) << path << ": the inline namespace is not that of the version";
      }
    }
  }
  EXPECT_GT(checked, 400u);
}

}}  // namespace tessera::house
