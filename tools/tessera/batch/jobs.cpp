#include "batch/jobs.h"

#include <glob.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "batch/batch.h"
#include "batch/kept.h"
#include "console/progress.h"
#include "line/arguments.h"
#include "tessera/io.h"

namespace tessera::cli {
namespace {

namespace fs = std::filesystem;
constexpr std::string_view placeholder = "{name}";

bool exists(const std::string& name) {
  std::error_code error;
  return fs::exists(fs::symlink_status(name, error));
}

std::vector<std::string> matches_of(const std::string& pattern) {
  glob_t found{};
  std::vector<std::string> names;
  if (::glob(pattern.c_str(), GLOB_NOSORT | GLOB_MARK, nullptr, &found) == 0) {
    for (std::size_t k = 0; k < found.gl_pathc; ++k) {
      const std::string_view name = found.gl_pathv[k];
      if (!name.ends_with('/')) names.emplace_back(name);  // skips folders
    }
  }
  ::globfree(&found);
  std::sort(names.begin(), names.end());
  return names;
}

std::vector<std::string> expand(const std::vector<std::string>& words, std::vector<std::string>& unmatched) {
  std::vector<std::string> files;
  for (const std::string& word : words) {
    if (word.find_first_of("*?[") == std::string::npos || exists(word)) {
      files.push_back(word);
      continue;
    }
    const std::vector<std::string> names = matches_of(word);
    if (names.empty()) unmatched.push_back(word);
    files.insert(files.end(), names.begin(), names.end());
  }
  return files;
}

std::string output_of(const std::string& input, std::string output, const OutputRule& rule) {
  fs::path path = input;
  if (lower_extension(path) == ".gz") path = path.stem();
  const std::string name = path.stem().string();
  if (is_folder(output)) return (fs::path(output) / (name + rule.extension)).string();
  for (std::size_t at = output.find(placeholder); at != std::string::npos; at = output.find(placeholder, at)) {
    output.replace(at, placeholder.size(), name);
    at += name.size();
  }
  return output;
}

void check_outputs_differ(const std::vector<Job>& jobs, const OutputRule& rule) {
  std::map<std::string, std::string> inputs;  // by output
  for (const Job& job : jobs) {
    const auto [place, is_new] = inputs.emplace(fs::path(job.output).lexically_normal().string(), job.inputs[0]);
    if (is_new || job.output.empty()) continue;
    throw UsageError(rule.option, place->second + " and " + job.inputs[0] + " would both be written as " + job.output);
  }
}

/// Never destroyed, so that what it holds is not, either.
std::vector<std::shared_ptr<void>>& kept_objects() {
  static auto& objects = *new std::vector<std::shared_ptr<void>>;
  return objects;
}

}  // namespace

void keep(std::shared_ptr<void> object) { kept_objects().push_back(std::move(object)); }
void drop_kept() { kept_objects().clear(); }

Json error_json(const Job& job, const Status& status) {
  return {{"files", job.inputs},
          {"error", {{"code", std::string(name(status.code()))}, {"message", status.message()}}}};
}

std::vector<std::string> Plan::outputs() const {
  std::vector<std::string> names;
  for (const Job& job : jobs) names.push_back(job.output);
  return names;
}

bool is_folder(const std::string& output) {
  std::error_code error;
  return output.ends_with('/') || fs::is_directory(output, error);
}

Plan plan_jobs(const std::vector<std::string>& words, const std::string& output, const OutputRule& rule,
               const std::vector<std::string>& listed) {
  Plan plan;
  std::vector<std::string> files = expand(words, plan.unmatched);
  files.insert(files.end(), listed.begin(), listed.end());
  const bool each =
      output.empty() ? !rule.together : is_folder(output) || output.find(placeholder) != std::string::npos;
  for (const std::string& file : files) {
    if (each || plan.jobs.empty()) {
      plan.jobs.push_back({{file}, each ? output_of(file, output, rule) : output});
    } else {
      plan.jobs[0].inputs.push_back(file);
    }
  }
  check_outputs_differ(plan.jobs, rule);
  check_overwriting(rule.option, plan.outputs(), files);
  return plan;
}

Status run_jobs(const Plan& plan, const CommonOptions& options,
                const std::function<Status(const Job&, Timings&)>& work) {
  if (!options.batch.list.empty()) return run_batch(plan, options, work);
  Status failure;
  const auto fail = [&](const Job& job, const Status& status) {
    if (!is_already_said(status)) {
      complain(status.message());
      if (options.json)
        (void)print_json(error_json(job, status));  // the failure counts whether or not it can be printed
    }
    failure = already_said(status.code());
  };
  for (const std::string& pattern : plan.unmatched) {
    fail({{pattern}, {}}, Status(StatusCode::io_error, pattern + ": expected files that match, found none"));
  }
  const Stopwatch clock;
  for (std::size_t k = 0; k < plan.jobs.size(); ++k) {
    const Job& job = plan.jobs[k];
    drop_kept();
    if (plan.jobs.size() > 1) {
      const auto done = static_cast<double>(k), rest = static_cast<double>(plan.jobs.size() - k);
      const std::string left = k == 0 ? "" : ", about " + duration_text(clock.seconds() * rest / done) + " left";
      set_progress_subject("(" + std::to_string(k + 1) + "/" + std::to_string(plan.jobs.size()) + left + ") " +
                           fs::path(job.inputs[0]).filename().string());
    }
    Timings timings;
    const Status status = work(job, timings);
    if (status.code() == StatusCode::cancelled || interrupted()) return status.ok() ? failure : status;
    if (!status.ok()) fail(job, status);
    if (options.timings && !options.json) complain(job.inputs[0] + ": " + timings.as_text());
  }
  return failure;
}

}  // namespace tessera::cli
