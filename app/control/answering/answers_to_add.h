// Answers added to sessions after their trials.
#pragma once

#include <filesystem>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "app/control/answering/answer_table.h"
#include "core/session.h"

namespace elbowroom::control {

struct SessionAnswers {
  std::filesystem::path session;
  std::string participant;
  std::vector<core::EventContent> to_add;
  std::size_t unchanged = 0;  // the session has the same answer already
  std::size_t empty = 0;      // left blank on paper
};

// Finds the session and the item of each answer, and what it says. Nothing is written. One a session, in
// their order. Throws: core::Error{kRange} naming the first answer (`where`) of which no session or item, or
// several, fit, that its item can't have, or that is given twice; and a session that has no frame, or is
// being recorded; what sessions::SessionReader throws.
[[nodiscard]] std::vector<SessionAnswers> MatchAnswers(std::span<const std::filesystem::path> sessions,
                                                       std::span<const GivenAnswer> given,
                                                       const std::stop_token& stop);

// Session by session, each all or none. Throws: as sessions::AddAfterTrial; the sessions before have theirs
// then, and MatchAnswers doesn't give them again.
void AddAnswers(std::span<const SessionAnswers> answers);

}  // namespace elbowroom::control
