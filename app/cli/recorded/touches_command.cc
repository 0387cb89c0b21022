// elbowroom touches S.db [set TOUCH... | import FILE]: what reviewers follow, and what they say of it.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/options/command.h"
#include "app/cli/options/value_json.h"
#include "app/control/outcome_tracker.h"
#include "app/control/reviewing/review_remarks.h"
#include "core/findings/finding_names.h"
#include "core/plain_text.h"
#include "core/system/utc_time.h"
#include "sessions/bcf/review_import.h"
#include "sessions/review_editor.h"

namespace elbowroom::cli {
namespace {

using core::Finding;
using core::ReviewStatus;

constexpr std::size_t kShownCommentBytes = 100;

struct TouchesOptions {
  std::filesystem::path session;
  std::optional<ReviewStatus> only;
  std::string part;
};

struct SetOptions {
  std::vector<std::string> touches;
  std::optional<ReviewStatus> status;
  std::string comment;
  std::string by;
};

std::vector<std::string> StatusNames() {
  std::vector<std::string> names;
  for (const ReviewStatus status : core::kReviewStatuses) names.emplace_back(core::ToString(status));
  return names;
}

void AddStatusOption(CLI::App* command, std::optional<ReviewStatus>* status, const std::string& help) {
  command
      ->add_option_function<std::string>(
          "--status", [status](const std::string& text) { *status = core::ParseReviewStatus(text); }, help)
      ->check(CLI::IsMember(StatusNames()));
}

nlohmann::json RemarkJson(const core::ReviewRemark& remark) {
  return {{"at_utc", remark.at_utc},
          {"by", remark.by},
          {"status", remark.status ? nlohmann::json(core::ToString(*remark.status)) : nlohmann::json()},
          {"comment", remark.comment}};
}

nlohmann::json FindingJson(const Finding& finding) {
  nlohmann::json comments = nlohmann::json::array();
  for (const core::ReviewRemark& remark : finding.remarks) comments.push_back(RemarkJson(remark));
  const bool is_here = finding.presence == core::FindingPresence::kHere;
  return {
      {"id", finding.id},
      {"kind", core::ToString(finding.kind)},
      {"number", is_here ? nlohmann::json(finding.number) : nlohmann::json()},
      {"part", finding.part},
      {"begin_s", finding.begin_s},
      {"end_s", finding.end_s},
      {"place_in_part_mm", finding.place_in_part_mm ? JsonOf(*finding.place_in_part_mm) : nlohmann::json()},
      {"presence", core::ToString(finding.presence)},
      {"status", core::ToString(finding.status())},
      {"comments", comments}};
}

std::string FindingText(const Finding& finding) {
  std::string text =
      fmt::format("{}  {:<9}  {:<14}  {:>8.2f} to {:>8.2f} s  {}", finding.id.substr(0, core::kShownIdLength),
                  core::ToString(finding.status()), core::NameOf(finding), finding.begin_s, finding.end_s,
                  core::OneLine(finding.part));
  if (finding.presence == core::FindingPresence::kGone) text += "  (gone: judged again, and not there)";
  if (finding.presence == core::FindingPresence::kNotChecked) text += "  (not checked again)";
  const auto said = std::find_if(finding.remarks.rbegin(), finding.remarks.rend(),
                                 [](const core::ReviewRemark& remark) { return !remark.comment.empty(); });
  if (said != finding.remarks.rend())
    text += fmt::format("\n          {}, {}: {}", core::OneLine(said->by, kShownCommentBytes), said->at_utc,
                        core::OneLine(said->comment, kShownCommentBytes));
  return text;
}

bool IsListed(const TouchesOptions& options, const Finding& finding) {
  return (!options.only || finding.status() == *options.only) &&
         (options.part.empty() || finding.part == options.part);
}

// The statuses are counted over all findings.
CommandResult ListOf(const TouchesOptions& options, const std::vector<Finding>& findings) {
  CommandResult result;
  result.json = {{"session", options.session.string()}, {"touches", nlohmann::json::array()}};
  for (const Finding& finding : findings) {
    if (!IsListed(options, finding)) continue;
    result.json["touches"].push_back(FindingJson(finding));
    result.text += FindingText(finding) + "\n";
  }
  std::string counts;
  for (const ReviewStatus status : core::kReviewStatuses) {
    const auto count = std::ranges::count(findings, status, &Finding::status);
    result.json["counts"][std::string(core::ToString(status))] = count;
    if (count > 0)
      counts += fmt::format("{}{} {}", counts.empty() ? "" : ", ", count, core::ToString(status));
  }
  result.text += fmt::format("{}: {}", options.session.string(),
                             findings.empty() ? "no touch and no near miss" : counts);
  return result;
}

std::vector<Finding> FindingsOf(const TouchesOptions& options, const CommandContext& context) {
  return control::OpenWithOutcome(options.session, context.progress, context.stop).findings();
}

CommandResult List(const TouchesOptions& options, const CommandContext& context) {
  return ListOf(options, FindingsOf(options, context));
}

// The ids of the findings, each once.
std::vector<core::FindingId> ChangedBy(const std::vector<sessions::FindingRemark>& remarks) {
  std::vector<core::FindingId> ids;
  for (const sessions::FindingRemark& said : remarks)
    if (std::ranges::find(ids, said.finding) == ids.end()) ids.push_back(said.finding);
  return ids;
}

// Adds the remarks to the session's file, and to `findings`.
void AddTo(const TouchesOptions& options, const std::vector<sessions::FindingRemark>& remarks,
           std::vector<Finding>* findings) {
  sessions::AddRemarks(options.session, remarks);
  for (const sessions::FindingRemark& said : remarks)
    std::ranges::find(*findings, said.finding, &Finding::id)->remarks.push_back(said.remark);
}

CommandResult Set(const TouchesOptions& options, const SetOptions& set, const CommandContext& context) {
  const core::ReviewRemark remark = {core::NowUtc(), set.by, set.status, set.comment};
  control::RequireFit(remark);
  std::vector<Finding> findings = FindingsOf(options, context);
  std::vector<sessions::FindingRemark> remarks;
  for (const std::string& text : set.touches) {
    const core::FindingId& id = core::FindFinding(findings, text).id;
    if (std::ranges::find(remarks, id, &sessions::FindingRemark::finding) == remarks.end())
      remarks.push_back({id, remark});
  }
  AddTo(options, remarks, &findings);
  CommandResult result = ListOf(options, findings);
  result.json["changed"] = ChangedBy(remarks);
  return result;
}

CommandResult Import(const TouchesOptions& options, const std::filesystem::path& file,
                     const CommandContext& context) {
  std::vector<Finding> findings = FindingsOf(options, context);
  const sessions::ReviewImport import = control::ReadReview(file, options.session, findings);
  if (!import.remarks.empty()) AddTo(options, import.remarks, &findings);
  CommandResult result = ListOf(options, findings);
  result.json["changed"] = ChangedBy(import.remarks);
  result.json["imported"] = {{"file", file.string()},
                             {"topics", import.topics},
                             {"topics_of_others", import.of_others},
                             {"remarks", import.remarks.size()},
                             {"notes", import.notes}};
  result.text += fmt::format("\n{}: {} topics, {} remarks taken over", file.string(), import.topics,
                             import.remarks.size());
  for (const std::string& note : import.notes) result.text += "\nnote: " + note;
  return result;
}

}  // namespace

void AddTouchesCommand(CLI::App& app, Choice* choice) {
  CLI::App* command =
      app.add_subcommand("touches", "list touches and near misses with their reviews, and add to these");
  auto options = std::make_shared<TouchesOptions>();
  command->add_option("SESSION", options->session, "the session (S.db)")->required();
  AddStatusOption(command, &options->only, "list only those of this status");
  command->add_option("--part", options->part, "list only those on this part");
  // Runs after that of 'set'.
  command->callback([=] {
    if (!choice->action)
      choice->action = [=](const CommandContext& context) { return List(*options, context); };
  });

  CLI::App* set = command->add_subcommand("set", "say something of touches: a status, a comment, or both");
  auto said = std::make_shared<SetOptions>();
  said->by = control::LoginName();
  set->add_option("TOUCH", said->touches,
                  "ids as they are listed, or their beginnings; numbers of touches; \"near miss 2\"")
      ->required();
  AddStatusOption(set, &said->status, "the new status");
  set->add_option("--comment", said->comment, "what there is to say");
  set->add_option("--by", said->by, "who says it (default: the name that you are logged in with)");
  set->callback([=] {
    if (!said->status && said->comment.empty()) throw CLI::RequiredError("--status or --comment");
    choice->action = [=](const CommandContext& context) { return Set(*options, *said, context); };
  });

  CLI::App* import =
      command->add_subcommand("import", "take over statuses and comments from a BCF file that came back");
  auto file = std::make_shared<std::filesystem::path>();
  import->add_option("FILE", *file, "the BCF file (.bcfzip, .bcf), of version 2.1")->required();
  import->callback([=] {
    choice->action = [=](const CommandContext& context) { return Import(*options, *file, context);
};
}  // namespace elbowroom::cli
);
}

}  // namespace elbowroom::cli
