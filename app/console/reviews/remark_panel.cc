#include "app/console/reviews/remark_panel.h"

#include <QDateTime>
#include <QGridLayout>
#include <QLocale>
#include <QSettings>
#include <QVBoxLayout>

#include "app/console/reviews/finding_model.h"
#include "app/control/reviewing/review_remarks.h"
#include "core/system/utc_time.h"

namespace elbowroom::console {
namespace {

constexpr const char* kReviewerKey = "review/name";

QString LocalTime(const std::string& at_utc) {
  const QDateTime at = QDateTime::fromString(QString::fromStdString(at_utc), Qt::ISODate);
  return at.isValid() ? QLocale().toString(at.toLocalTime(), QLocale::ShortFormat)
                      : QString::fromStdString(at_utc);
}

QString LineOf(const core::ReviewRemark& remark) {
  QString line =
      QString("<b>%1</b>, %2")
          .arg(QString::fromStdString(remark.by).toHtmlEscaped(), LocalTime(remark.at_utc).toHtmlEscaped());
  if (remark.status) line += ": <i>" + StatusText(*remark.status) + "</i>";
  if (!remark.comment.empty())
    line += "<br>" + QString::fromStdString(remark.comment).toHtmlEscaped().replace('\n', "<br>");
  return line;
}

}  // namespace

RemarkPanel::RemarkPanel(QWidget* parent)
    : QGroupBox(parent),
      said_(new QTextBrowser),
      status_(new QComboBox),
      comment_(new QLineEdit),
      name_(new QLineEdit),
      say_(new QPushButton(tr("&Add"))) {
  said_->setObjectName("remarks");
  said_->setAccessibleName(tr("What was said"));
  said_->setMinimumHeight(40);
  said_->setOpenLinks(false);
  status_->setObjectName("remark_status");
  status_->setAccessibleName(tr("Status"));
  status_->setToolTip(tr("The status that it gets with Add; it is kept in the session's file"));
  for (const core::ReviewStatus status : core::kReviewStatuses)
    status_->addItem(StatusText(status), static_cast<int>(status));
  comment_->setObjectName("remark_comment");
  comment_->setAccessibleName(tr("Comment"));
  comment_->setPlaceholderText(tr("Comment"));
  comment_->setToolTip(tr("What there is to say; Enter adds it"));
  name_->setObjectName("remark_name");
  name_->setAccessibleName(tr("Your name"));
  name_->setPlaceholderText(tr("Your name"));
  name_->setToolTip(tr("Who says it: kept with the remark, and for the next time"));
  name_->setText(QSettings().value(kReviewerKey, QString::fromStdString(control::LoginName())).toString());
  say_->setObjectName("remark_add");
  say_->setToolTip(tr("Write status and comment into the session's file"));
  auto* grid = new QGridLayout;
  grid->addWidget(status_, 0, 0);
  grid->addWidget(comment_, 0, 1, 1, 2);
  grid->addWidget(name_, 1, 0, 1, 2);
  grid->addWidget(say_, 1, 2);
  grid->setColumnStretch(1, 1);
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(6, 4, 6, 6);
  column->addWidget(said_, 1);
  column->addLayout(grid);
  connect(status_, &QComboBox::currentIndexChanged, this, &RemarkPanel::Enable);
  connect(comment_, &QLineEdit::textChanged, this, &RemarkPanel::Enable);
  connect(comment_, &QLineEdit::returnPressed, this, &RemarkPanel::Say);
  connect(name_, &QLineEdit::textChanged, this, &RemarkPanel::Enable);
  connect(say_, &QPushButton::clicked, this, &RemarkPanel::Say);
  Clear();
}

void RemarkPanel::Open(const core::Finding& finding) {
  const bool is_another = !finding_ || finding_->id != finding.id;
  const bool is_written = !is_another && finding.remarks.size() > finding_->remarks.size();
  finding_ = finding;
  setTitle(tr("%1 on %2").arg(FindingText(finding), QString::fromStdString(finding.part)));
  QStringList lines;
  for (const core::ReviewRemark& remark : finding.remarks) lines.prepend(LineOf(remark));
  said_->setHtml(lines.isEmpty() ? tr("<i>Nothing was said of it yet.</i>") : lines.join("<br>"));
  status_->setCurrentIndex(status_->findData(static_cast<int>(finding.status())));
  if (is_another || is_written) comment_->clear();
  Enable();
}

void RemarkPanel::Clear() {
  finding_.reset();
  setTitle(tr("Remarks"));
  said_->setHtml(tr("<i>Choose a touch or a near miss.</i>"));
  comment_->clear();
  Enable();
}

void RemarkPanel::SetCanSay(bool can_say) {
  can_say_ = can_say;
  Enable();
}

std::optional<core::ReviewStatus> RemarkPanel::NewStatus() const {
  const auto status = static_cast<core::ReviewStatus>(status_->currentData().toInt());
  return finding_ && status != finding_->status() ? std::optional(status) : std::nullopt;
}

void RemarkPanel::Enable() {
  for (QWidget* widget : std::initializer_list<QWidget*>{status_, comment_, name_})
    widget->setEnabled(finding_.has_value());
  const bool has_something = NewStatus() || !comment_->text().trimmed().isEmpty();
  say_->setEnabled(finding_ && can_say_ && has_something && !name_->text().trimmed().isEmpty());
}

void RemarkPanel::Say() {
  if (!say_->isEnabled()) return;
  const QString name = name_->text().trimmed();
  QSettings().setValue(kReviewerKey, name);
  const core::ReviewRemark remark{core::NowUtc(), name.toStdString(), NewStatus(),
                                  comment_->text().trimmed().toStdString()};
  emit Said(finding_->id, remark);
}

}  // namespace elbowroom::console
