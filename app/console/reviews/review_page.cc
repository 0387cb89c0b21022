#include "app/console/reviews/review_page.h"

#include <QDesktopServices>
#include <QHBoxLayout>
#include <QKeyEvent>
#include <QSplitter>
#include <QStyle>
#include <QUrl>
#include <QVBoxLayout>
#include <algorithm>

#include "app/console/desktop/session_place.h"
#include "app/console/desktop/theme.h"
#include "app/console/reviews/keep_out_dialog.h"
#include "app/console/reviews/recent_sessions.h"
#include "app/console/reviews/review_start.h"
#include "app/console/reviews/session_facts.h"
#include "app/console/reviews/what_if_text.h"
#include "app/console/view/file_question.h"

namespace elbowroom::console {
namespace {

constexpr int kSidePx = 500;
constexpr int kPlayMs = 33;               // between two looks at the clock
constexpr std::size_t kMostRowsSeen = 8;  // of the timeline; the others are scrolled to

// It scrolls by the wheel and its bar: the keys are the page's.
class ScrolledTimeline : public QScrollArea {
 protected:
  void keyPressEvent(QKeyEvent* event) override { event->ignore(); }
};

QString TextFrom(const std::filesystem::path& path) { return QString::fromStdString(path.string()); }

}  // namespace

ReviewPage::ReviewPage(QWidget* parent)
    : QWidget(parent), desk_(new ReviewDesk(this)), messages_(new MessageBar), stack_(new QStackedWidget) {
  auto* start = new ReviewStart;
  session_page_ = MakeSessionPage();
  MakeActions();
  stack_->addWidget(start);
  stack_->addWidget(session_page_);
  messages_->setObjectName("review_messages");
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->addWidget(messages_);
  column->addWidget(stack_, 1);
  column->addLayout(MakeJobLine());
  player_.setInterval(kPlayMs);
  connect(&player_, &QTimer::timeout, this, &ReviewPage::PlayOn);
  connect(start, &ReviewStart::OpenAsked, this, &ReviewPage::AskForSession);
  connect(start, &ReviewStart::Chosen, this, [this](const QString& file) { Open(file.toStdString()); });
  FollowDesk();
  FollowPanels();
  ShowState();
}

ReviewPage::~ReviewPage() = default;

QWidget* ReviewPage::MakeSessionPage() {
  findings_ = new FindingPanel;
  remarks_ = new RemarkPanel;
  what_if_ = new WhatIfPanel;
  timeline_ = new TimelineView;
  timeline_->setObjectName("timeline");
  timeline_->setAccessibleName(tr("Timeline of the session"));
  auto* left = new QWidget;
  view_column_ = new QVBoxLayout(left);
  view_column_->setContentsMargins(0, 0, 0, 0);
  section_ = new SectionPanel;
  section_->hide();
  view_column_->addWidget(section_);
  view_column_->addWidget(what_if_);
  auto* right = new QWidget;
  auto* lists = new QVBoxLayout(right);
  lists->setContentsMargins(0, 0, 0, 0);
  lists->addWidget(findings_, 3);
  lists->addWidget(remarks_, 2);
  auto* middle = new QSplitter(Qt::Horizontal);
  middle->setChildrenCollapsible(false);
  middle->addWidget(left);
  middle->addWidget(right);
  middle->setStretchFactor(0, 3);
  middle->setStretchFactor(1, 2);
  middle->setSizes({3 * kSidePx / 2, kSidePx});  // in that proportion, whatever they hint at
  auto* page = new QWidget;
  auto* column = new QVBoxLayout(page);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(4);
  column->addLayout(MakeHeader());
  column->addWidget(middle, 1);
  column->addLayout(MakeTransport());
  return page;
}

QPushButton* ReviewPage::AddButton(QLayout* row, const char* name, const QString& text, const QString& tip) {
  auto* button = new QPushButton(text);
  button->setObjectName(name);
  button->setToolTip(tip);
  button->setFocusPolicy(Qt::TabFocus);  // a click leaves the keys to the session
  row->addWidget(button);
  return button;
}

QLayout* ReviewPage::MakeHeader() {
  title_ = new QLabel;
  title_->setObjectName("review_title");
  title_->setTextFormat(Qt::PlainText);
  title_->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);  // it gives way to the buttons
  facts_ = new QLabel;
  facts_->setObjectName("review_facts");
  facts_->setTextFormat(Qt::PlainText);
  facts_->setForegroundRole(QPalette::PlaceholderText);
  facts_->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
  auto* texts = new QVBoxLayout;
  texts->setSpacing(0);
  texts->addWidget(title_);
  texts->addWidget(facts_);
  return texts;
}

void ReviewPage::MakeActions() {
  buttons_ = new QWidget;
  auto* row = new QHBoxLayout(buttons_);
  row->setContentsMargins(0, 0, 0, 0);
  section_button_ =
      AddButton(row, "review_section", tr("&Section"),
                tr("Cut parts and hull open by planes; handles in the picture move and turn the chosen one"));
  section_button_->setCheckable(true);
  connect(section_button_, &QPushButton::toggled, section_, &QWidget::setVisible);
  heat_button_ =
      AddButton(row, "review_heat", tr("&Heat"),
                tr("Colour the parts by how long each place was touched in the session, in s (H)"));
  heat_button_->setCheckable(true);
  connect(heat_button_, &QPushButton::toggled, this, [this](bool is_on) {
    if (is_on && desk_->is_open()) return desk_->FindHeat();
    if (view_ != nullptr) view_->SetHeat(nullptr);
  });
  hull_look_ = new HullLookButton(LooksOffered::kWithoutPictures);
  hull_look_->setObjectName("review_hull_look");
  hull_look_->setFocusPolicy(Qt::TabFocus);
  row->addWidget(hull_look_);
  auto* open = AddButton(row, "review_open_another", tr("&Open …"), tr("Open another session (.db)"));
  auto* report =
      AddButton(row, "review_report", tr("&Report"), tr("Write the session's report beside it, and open it"));
  auto* bcf_out = AddButton(row, "review_bcf_out", tr("&BCF out …"),
                            tr("Write touches and near misses with their statuses for a CAD team (.bcfzip)"));
  auto* bcf_in = AddButton(row, "review_bcf_in", tr("BCF &in …"),
                           tr("Take over statuses and comments that a CAD team sent back (.bcfzip)"));
  auto* keep_out = AddButton(row, "review_keep_out", tr("&Keep-out …"),
                             tr("Write the space that hands and tools took, as a closed mesh in mm"));
  connect(open, &QPushButton::clicked, this, &ReviewPage::AskForSession);
  connect(report, &QPushButton::clicked, desk_, &ReviewDesk::WriteReport);
  connect(bcf_out, &QPushButton::clicked, this, [this] { AskForBcf(true); });
  connect(bcf_in, &QPushButton::clicked, this, [this] { AskForBcf(false); });
  connect(keep_out, &QPushButton::clicked, this, &ReviewPage::AskForKeepOut);
  job_buttons_ = {report, bcf_out, bcf_in, keep_out};
  buttons_->hide();
  actions_ = new QWidget(this);
  auto* actions = new QHBoxLayout(actions_);
  actions->setContentsMargins(0, 0, 0, 0);
  actions->addWidget(buttons_);
}

QLayout* ReviewPage::MakeTransport() {
  const auto tool = [](const char* name, const QString& tip) {
    auto* button = new QToolButton;
    button->setObjectName(name);
    button->setAccessibleName(tip);
    button->setToolTip(tip);
    button->setFocusPolicy(Qt::NoFocus);  // Space plays, wherever the user was
    return button;
  };
  before_ = tool("touch_before", tr("To the touch before (Page Up)"));
  play_ = tool("play", tr("Play at the recorded pace (Space)"));
  play_->setCheckable(true);
  next_ = tool("touch_next", tr("To the next touch (Page Down)"));
  TakeIcons();
  time_ = new QLabel;
  time_->setObjectName("review_time");
  time_->setMinimumWidth(fontMetrics().horizontalAdvance("frame 00000, 0000.00 s"));
  connect(before_, &QToolButton::clicked, this, [this] { StepToFinding(-1); });
  connect(next_, &QToolButton::clicked, this, [this] { StepToFinding(1); });
  connect(play_, &QToolButton::toggled, this, &ReviewPage::Play);
  auto* keys = new QHBoxLayout;
  keys->addWidget(before_);
  keys->addWidget(play_);
  keys->addWidget(next_);
  auto* left = new QVBoxLayout;
  left->addLayout(keys);
  left->addWidget(time_);
  left->addStretch(1);
  auto* row = new QHBoxLayout;
  row->addLayout(left);
  timeline_area_ = new ScrolledTimeline;
  timeline_area_->setObjectName("timeline_area");
  timeline_area_->setWidgetResizable(true);
  timeline_area_->setFrameShape(QFrame::NoFrame);
  timeline_area_->setFocusPolicy(Qt::NoFocus);
  timeline_area_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  timeline_area_->setWidget(timeline_);
  row->addWidget(timeline_area_, 1);
  return row;
}

QLayout* ReviewPage::MakeJobLine() {
  job_line_ = new QWidget;
  job_text_ = new QLabel;
  job_text_->setObjectName("review_job");
  job_progress_ = new QProgressBar;
  job_progress_->setObjectName("review_job_progress");
  job_progress_->setTextVisible(false);
  auto* cancel = new QPushButton(tr("Cancel"));
  cancel->setObjectName("review_job_cancel");
  cancel->setToolTip(tr("Give up what is being done; no half-written file stays"));
  connect(cancel, &QPushButton::clicked, desk_, &ReviewDesk::CancelJob);
  auto* row = new QHBoxLayout(job_line_);
  row->setContentsMargins(0, 0, 0, 0);
  row->addWidget(job_text_);
  row->addWidget(job_progress_, 1);
  row->addWidget(cancel);
  job_line_->hide();
  auto* line = new QHBoxLayout;
  line->addWidget(job_line_);
  return line;
}

void ReviewPage::FollowDesk() {
  connect(desk_, &ReviewDesk::StateChanged, this, &ReviewPage::ShowState);
  connect(desk_, &ReviewDesk::Opened, this, &ReviewPage::ShowSession);
  connect(desk_, &ReviewDesk::FrameArrived, this, &ReviewPage::ShowFrame);
  connect(desk_, &ReviewDesk::HeatFound, this, &ReviewPage::ShowHeat);
  connect(desk_, &ReviewDesk::FindingsChanged, this, &ReviewPage::ShowFindings);
  connect(desk_, &ReviewDesk::WhatIfArrived, this, &ReviewPage::ShowWhatIf);
  connect(desk_, &ReviewDesk::WhatIfProgressed, what_if_, &WhatIfPanel::ShowProgress);
  connect(desk_, &ReviewDesk::NeededGapFound, what_if_, &WhatIfPanel::ShowNeeded);
  connect(desk_, &ReviewDesk::Progressed, this, &ReviewPage::ShowProgress);
  connect(desk_, &ReviewDesk::Failed, messages_, &MessageBar::ShowError);
  connect(desk_, &ReviewDesk::Noted, messages_, &MessageBar::ShowNote);
  connect(desk_, &ReviewDesk::ReportWritten, this,
          [](const QString& html_file) { QDesktopServices::openUrl(QUrl::fromLocalFile(html_file)); });
}

void ReviewPage::FollowPanels() {
  connect(timeline_, &TimelineView::Scrubbed, this, [this](double time_s) {
    Play(false);
    desk_->Show(desk_->session().PositionAt(time_s));
  });
  connect(timeline_, &TimelineView::FindingChosen, findings_, &FindingPanel::Choose);
  connect(timeline_, &TimelineView::FindingChosen, this, &ReviewPage::GoToFinding);
  connect(findings_, &FindingPanel::Chosen, this, &ReviewPage::GoToFinding);
  connect(remarks_, &RemarkPanel::Said, desk_, &ReviewDesk::Say);
  connect(what_if_, &WhatIfPanel::Held, desk_, &ReviewDesk::Hold);
  connect(what_if_, &WhatIfPanel::NeededAsked, desk_, &ReviewDesk::FindNeededGap);
}

void ReviewPage::Open(const std::filesystem::path& session) {
  Play(false);
  messages_->hide();
  desk_->Open(session);
}

void ReviewPage::AskForSession() {
  const QString last = RecentSessions().value(0, TextFrom(SessionsFolder()));
  AskForFileToRead(
      this, {.title = tr("Open a session"), .beside = last, .filter = tr("Sessions (*.db);;All files (*)")},
      [this](const QString& file) { Open(file.toStdString()); });
}

void ReviewPage::Fit() {
  if (view_ != nullptr) view_->Fit();
}

// It owns a thread and a graphics context: not before they are needed.
void ReviewPage::MakeView() {
  view_ = new OperatorView;
  view_->setObjectName("review_view");
  view_column_->insertWidget(0, view_, 1);
  connect(view_, &OperatorView::Failed, messages_, &MessageBar::ShowError);
  connect(hull_look_, &HullLookButton::Chosen, view_, &OperatorView::SetLook);
  auto* picker = new PartPicker(view_, this);
  auto* tool = new SectionTool(section_, view_, picker, this);
  connect(picker, &PartPicker::Failed, messages_, &MessageBar::ShowError);
  connect(section_, &SectionPanel::Failed, messages_, &MessageBar::ShowError);
  connect(tool, &SectionTool::Advised, this, [this](const QString& line) {
    if (!line.isEmpty()) messages_->ShowNote(line);
  });
}

void ReviewPage::ShowSession() {
  const control::ReviewedSession& session = desk_->session();
  RememberSession(session.path());
  if (view_ == nullptr) MakeView();
  view_->Clear();
  title_->setText(TitleOf(session));
  title_->setToolTip(TextFrom(session.path()));
  facts_->setText(FactsOf(session));
  facts_->setToolTip(facts_->text());
  timeline_->Open(desk_->timeline());
  timeline_area_->setFixedHeight(
      std::min(timeline_->sizeHint().height(), TimelineView::HeightOf(kMostRowsSeen)));
  what_if_->Open(session.header());
  section_->Open(session.header().rig.workspace_mm);
  view_->SetCut(section_->cut());
  view_->SetKnowledge(control::KnowledgeOf(session.header().rig, session.header().rig_quality));
  view_->SetHeat(nullptr);  // of another session
  if (heat_button_->isChecked()) desk_->FindHeat();
  remarks_->Clear();
  findings_->Forget();
  ShowFindings();
  buttons_->show();
  stack_->setCurrentWidget(session_page_);
  timeline_->setFocus();
}

void ReviewPage::ShowHeat(const control::SharedHeatLayer& heat) {
  if (heat_button_->isChecked()) view_->SetHeat(heat, tr("the whole session, as recorded"));
}

void ReviewPage::ShowFindings() {
  findings_->Open(desk_->findings());
  if (const auto chosen = findings_->chosen()) remarks_->Open(desk_->findings()[*chosen].finding);
  ShowWhatIf();
}

void ReviewPage::ShowFrame(const control::ScrubbedFrame& frame) {
  if (!frame.result) return messages_->ShowError(QString::fromStdString(frame.error));
  const core::FrameRecord& record = frame.result->record;
  view_->ShowFrame(frame.result);
  timeline_->ShowTime(record.time_s);
  time_->setText(tr("frame %1, %2 s").arg(record.frame).arg(record.time_s, 0, 'f', 2));
  what_if_->ShowGaps(record.spacing_mm);
  if (!frame.held_mm.empty()) what_if_->ShowFrame(*frame.result);
}

void ReviewPage::ShowWhatIf() {
  std::set<std::size_t> vanished;
  std::vector<control::TimelineRow> tried;
  if (const auto& what_if = desk_->what_if()) {
    tried = control::RowsOf(desk_->session().header().layout, what_if->outcome);
    for (const auto* gone : {&what_if->vanished, &what_if->eased})
      for (std::size_t i = 0; i < desk_->findings().size(); ++i)
        if (std::ranges::find(*gone, desk_->findings()[i].finding.id) != gone->end()) vanished.insert(i);
    what_if_->ShowWhatIf(*what_if);
  } else if (desk_->held_mm().empty()) {
    what_if_->ShowRecorded();
  }
  timeline_->ShowTried(tried);
  timeline_->ShowVanished(vanished);
  findings_->ShowVanished(vanished, GapsText(desk_->held_mm()));
}

void ReviewPage::ShowState() {
  const bool is_free = desk_->is_open() && !desk_->is_busy();
  for (QPushButton* button : job_buttons_) button->setEnabled(is_free);
  remarks_->SetCanSay(is_free);
  what_if_->SetCanFind(is_free);
  job_line_->setVisible(desk_->is_busy());
  if (desk_->is_busy()) ShowProgress(0, 0, {});
}

void ReviewPage::ShowProgress(qint64 done, qint64 total, const QString& what) {
  job_text_->setText(what);
  job_progress_->setMaximum(static_cast<int>(std::max<qint64>(total, 0)));
  job_progress_->setValue(static_cast<int>(done));
}

void ReviewPage::GoToFinding(std::size_t finding) {
  const control::ListedFinding& listed = desk_->findings()[finding];
  Play(false);
  remarks_->Open(listed.finding);
  timeline_->ShowChosen(finding);
  desk_->Show(listed.worst_position.value_or(desk_->session().PositionAt(listed.worst_s)));
}

void ReviewPage::Step(int frames) {
  Play(false);
  const auto last = static_cast<std::ptrdiff_t>(desk_->session().frames().size()) - 1;
  const auto to = static_cast<std::ptrdiff_t>(desk_->position()) + frames;
  desk_->Show(static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(to, 0, last)));
}

void ReviewPage::StepToFinding(int step) {
  const auto next = control::NextFinding(desk_->findings(), desk_->position(), step);
  if (!next) return;
  findings_->Choose(*next);
  GoToFinding(*next);
}

void ReviewPage::Play(bool plays) {
  play_->setChecked(plays);
  if (!desk_->is_open() || plays == player_.isActive()) return;
  if (!plays) {
    player_.stop();
    return TakeIcons();
  }
  const auto& frames = desk_->session().frames();
  const bool is_at_end = desk_->position() + 1 == frames.size();
  played_from_s_ = is_at_end ? frames.front().time_s : frames[desk_->position()].time_s;
  playing_.start();
  player_.start();
  TakeIcons();
}

void ReviewPage::TakeIcons() {
  const auto take = [this](QToolButton* button, QStyle::StandardPixmap icon) {
    button->setIcon(InTextColor(style()->standardIcon(icon)));
  };
  take(before_, QStyle::SP_MediaSkipBackward);
  take(play_, player_.isActive() ? QStyle::SP_MediaPause : QStyle::SP_MediaPlay);
  take(next_, QStyle::SP_MediaSkipForward);
}

void ReviewPage::changeEvent(QEvent* event) {
  QWidget::changeEvent(event);
  if (event->type() == QEvent::PaletteChange && before_ != nullptr) TakeIcons();
}

void ReviewPage::PlayOn() {
  const double now_s = played_from_s_ + 1e-3 * static_cast<double>(playing_.elapsed());
  const std::size_t position = desk_->session().PositionAt(now_s);
  if (position != desk_->position()) desk_->Show(position);
  if (position + 1 == desk_->session().frames().size()) Play(false);
}

void ReviewPage::AskForBcf(bool out) {
  const std::filesystem::path session = desk_->session().path();
  const FileQuestion question{.title = out ? tr("Write touches into") : tr("Take over a review from"),
                              .beside = TextFrom(session.parent_path() / session.stem()) + "-touches.bcfzip",
                              .filter = tr("BCF files (*.bcfzip *.bcf)")};
  const auto work = [this, out, session](const QString& file) {
    if (desk_->session().path() != session)
      return messages_->ShowError(tr("Another session is open now: ask again"));
    if (out) {
      desk_->ExportBcf(file.toStdString());
    } else {
      desk_->ImportBcf(file.toStdString());
    }
  };
  if (out) {
    AskForFileToWrite(this, question, work);
  } else {
    AskForFileToRead(this, question, work);
  }
}

void ReviewPage::AskForKeepOut() {
  auto* dialog = new KeepOutDialog(desk_->session().path(), this);
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  connect(dialog, &KeepOutDialog::Asked, desk_, &ReviewDesk::WriteKeepOut);
  connect(desk_, &ReviewDesk::Opened, dialog, &QDialog::reject);  // it is for this session
  dialog->show();
}

void ReviewPage::keyPressEvent(QKeyEvent* event) {
  if (!desk_->is_open()) return QWidget::keyPressEvent(event);
  switch (event->key()) {
    case Qt::Key_Left:
      return Step(-1);
    case Qt::Key_Right:
      return Step(1);
    case Qt::Key_PageUp:
      return StepToFinding(-1);
    case Qt::Key_PageDown:
      return StepToFinding(1);
    case Qt::Key_Home:
      return Step(-static_cast<int>(desk_->session().frames().size()));
    case Qt::Key_End:
      return Step(static_cast<int>(desk_->session().frames().size()));
    case Qt::Key_H:
      return heat_button_->toggle();
    case Qt::Key_V:
      return hull_look_->Toggle(recon::HullAppearance::kCoverage);
    case Qt::Key_U:
      return hull_look_->Toggle(recon::HullAppearance::kUncertainty);
    case Qt::Key_Space:
      return Play(!player_.isActive());
    default:
      QWidget::keyPressEvent(event);
  }
}

}  // namespace elbowroom::console
