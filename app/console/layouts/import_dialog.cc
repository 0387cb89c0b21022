#include "app/console/layouts/import_dialog.h"

#include <QDialogButtonBox>
#include <QHeaderView>
#include <QRadioButton>
#include <QSignalBlocker>
#include <QVBoxLayout>
#include <utility>

#include "core/size_text.h"

namespace elbowroom::console {
namespace {

constexpr QSize kImportSize(720, 540);
constexpr int kNodeRole = Qt::UserRole;
enum Column { kName, kSize, kTriangles, kOpenEdges };

QString SizeWords(const Eigen::Vector3d& size_mm) {
  return QObject::tr("%1 mm").arg(QString::fromStdString(core::SizeText(size_mm)));
}

QString UnitWord(core::LengthUnit unit) {
  if (unit == core::LengthUnit::kInch) return QObject::tr("inches");  // "in in" doesn't read
  return QString::fromUtf8(core::ToString(unit).data());
}

void Untick(QTreeWidgetItem* item) {
  item->setCheckState(kName, Qt::Unchecked);
  for (int i = 0; i < item->childCount(); ++i) Untick(item->child(i));
}

void Collect(const QTreeWidgetItem* item, std::vector<std::string>& nodes) {
  if (item->checkState(kName) == Qt::Checked)
    nodes.push_back(item->data(kName, kNodeRole).toString().toStdString());
  for (int i = 0; i < item->childCount(); ++i) Collect(item->child(i), nodes);
}

QTreeWidgetItem* MakeItem(const QString& name, const QString& node, const Eigen::Vector3d& size_mm,
                          std::int64_t triangles, std::int64_t open_edges) {
  auto* item = new QTreeWidgetItem;
  item->setText(kName, name);
  item->setData(kName, kNodeRole, node);
  item->setToolTip(kName, node.isEmpty() ? QObject::tr("All of the file as one part") : node);
  item->setCheckState(kName, Qt::Unchecked);
  item->setText(kSize, SizeWords(size_mm));
  item->setText(kTriangles, QString::number(triangles));
  item->setText(kOpenEdges, open_edges == 0 ? QObject::tr("none") : QString::number(open_edges));
  for (const Column column : {kTriangles, kOpenEdges})
    item->setTextAlignment(column, Qt::AlignRight | Qt::AlignVCenter);
  return item;
}

}  // namespace

ImportDialog::ImportDialog(std::filesystem::path file, QWidget* parent)
    : QDialog(parent), file_(std::move(file)) {
  setObjectName("import_dialog");
  setWindowTitle(tr("Import %1").arg(QString::fromStdString(file_.filename().string())));
  Build();
  resize(kImportSize);
  StartReading(std::nullopt);
}

ImportDialog::~ImportDialog() = default;

void ImportDialog::Build() {
  headline_ = new QLabel;
  headline_->setObjectName("import_headline");
  headline_->setWordWrap(true);
  headline_->setTextFormat(Qt::PlainText);
  headline_->setTextInteractionFlags(Qt::TextSelectableByMouse);
  progress_ = new QProgressBar;
  progress_->setObjectName("import_progress");
  units_ = new QGroupBox(tr("The file carries no unit. How large is it?"));
  units_->setObjectName("import_units");
  units_->hide();
  unit_choices_ = new QButtonGroup(this);
  connect(unit_choices_, &QButtonGroup::idToggled, this, &ImportDialog::ShowState);
  new QVBoxLayout(units_);
  tree_ = new QTreeWidget;
  tree_->setObjectName("import_tree");
  tree_->setAccessibleName(tr("What is in the file"));
  tree_->setToolTip(tr("Tick what becomes a part, with all that hangs under it"));
  tree_->setHeaderLabels({tr("Take"), tr("Size"), tr("Triangles"), tr("Open edges")});
  tree_->header()->setSectionResizeMode(QHeaderView::ResizeToContents);
  tree_->header()->setStretchLastSection(false);
  tree_->header()->setSectionResizeMode(kName, QHeaderView::Stretch);
  connect(tree_, &QTreeWidget::itemChanged, this, &ImportDialog::Tick);
  warnings_ = new QLabel;
  warnings_->setObjectName("import_warnings");
  warnings_->setWordWrap(true);
  warnings_->setTextFormat(Qt::PlainText);
  warnings_->hide();
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Cancel);
  buttons->button(QDialogButtonBox::Cancel)->setObjectName("import_cancel");
  // Take is disabled while the file is read, and Enter mustn't mean Cancel after that.
  buttons->button(QDialogButtonBox::Cancel)->setAutoDefault(false);
  take_ = buttons->addButton(tr("&Take"), QDialogButtonBox::ActionRole);
  take_->setObjectName("import_take");
  take_->setDefault(true);
  connect(take_, &QPushButton::clicked, this, &ImportDialog::Take);
  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
  auto* column = new QVBoxLayout(this);
  for (QWidget* widget : std::initializer_list<QWidget*>{headline_, progress_, units_})
    column->addWidget(widget);
  column->addWidget(tree_, 1);
  column->addWidget(warnings_);
  column->addWidget(buttons);
}

void ImportDialog::StartReading(std::optional<core::LengthUnit> unit) {
  headline_->setText(tr("Reading %1 …").arg(QString::fromStdString(file_.string())));
  progress_->setRange(0, 0);
  progress_->show();
  auto read = std::make_shared<std::optional<control::PartPreview>>();
  const core::Progress progress([this](std::int64_t done, std::int64_t total, const std::string& what) {
    bridge_.PostLatest(Bridge::Stream::kProgress, [this, done, total, text = QString::fromStdString(what)] {
      progress_->setRange(0, total > 0 ? static_cast<int>(total) : 0);
      progress_->setValue(static_cast<int>(done));
      progress_->setFormat(text);
    });
  });
  job_ = std::make_unique<BackgroundJob>(
      bridge_,
      [read, progress, file = file_, unit](const std::stop_token& stop) {
        *read = control::PreviewPart(file, unit, progress, stop);
      },
      [this, read, is_chosen = unit.has_value()](const std::string& error) {
        preview_ = std::move(*read);
        Finish(error, is_chosen);
      });
  ShowState();
}

void ImportDialog::Finish(const std::string& error, bool is_chosen_unit) {
  job_.reset();
  progress_->hide();
  if (!error.empty()) {
    headline_->setText(QString::fromStdString(error));
  } else if (is_chosen_unit) {
    emit Taken(*preview_, TickedNodes());
    accept();
  } else {
    ShowPreview();
  }
  ShowState();
  emit Read();
}

void ImportDialog::ShowPreview() {
  const cad_import::ImportReport& report = preview_->report();
  const QString size = preview_->asks_for_unit() ? tr("size unknown") : SizeWords(preview_->size_mm);
  const QString unit =
      preview_->asks_for_unit() ? tr("no unit") : tr("in %1").arg(QString::fromStdString(report.unit));
  headline_->setText(tr("%1: %2, %3; %4 triangles, %5")
                         .arg(QString::fromStdString(file_.filename().string()), size, unit,
                              QString::number(report.triangles),
                              preview_->open_edges == 0 ? tr("no open edges")
                                                        : tr("%1 open edges").arg(preview_->open_edges)));
  QStringList lines;
  for (const std::string& warning : report.warnings) lines << "▲ " + QString::fromStdString(warning);
  warnings_->setText(lines.join('\n'));
  warnings_->setVisible(!lines.isEmpty());
  ShowUnits();
  ShowTree();
}

void ImportDialog::ShowUnits() {
  units_->setVisible(preview_->asks_for_unit());
  for (const control::SizeInUnit& size : preview_->sizes) {
    const QString unit = QString::fromUtf8(core::ToString(size.unit).data());
    auto* choice =
        new QRadioButton((size.is_likely ? tr("%1, if it is in %2 – most likely") : tr("%1, if it is in %2"))
                             .arg(SizeWords(size.size_mm), UnitWord(size.unit)));
    choice->setObjectName("import_unit:" + unit);
    choice->setChecked(size.is_likely);
    units_->layout()->addWidget(choice);
    unit_choices_->addButton(choice, static_cast<int>(size.unit));
  }
}

void ImportDialog::ShowTree() {
  const QSignalBlocker blocker(tree_);
  tree_->clear();
  QTreeWidgetItem* whole = MakeItem(QString::fromStdString(file_.filename().string()), {}, preview_->size_mm,
                                    preview_->report().triangles, preview_->open_edges);
  tree_->addTopLevelItem(whole);
  const bool is_assembly = preview_->model->instances.size() > 1;
  std::vector<QTreeWidgetItem*> items;
  if (is_assembly) {
    for (const control::PreviewNode& node : preview_->nodes) {
      QTreeWidgetItem* item = MakeItem(QString::fromStdString(node.name), QString::fromStdString(node.path),
                                       node.size_mm, node.triangles, node.open_edges);
      (node.parent ? items[*node.parent] : whole)->addChild(item);
      items.push_back(item);
    }
  } else {
    whole->setCheckState(kName, Qt::Checked);
  }
  tree_->expandAll();
  tree_->setColumnHidden(kSize, preview_->asks_for_unit());
}

void ImportDialog::Tick(QTreeWidgetItem* item) {
  if (item->checkState(kName) == Qt::Checked) {
    const QSignalBlocker blocker(tree_);
    for (int i = 0; i < item->childCount(); ++i) Untick(item->child(i));
    for (QTreeWidgetItem* above = item->parent(); above != nullptr; above = above->parent())
      above->setCheckState(kName, Qt::Unchecked);
  }
  ShowState();
}

std::vector<std::string> ImportDialog::TickedNodes() const {
  std::vector<std::string> nodes;
  for (int i = 0; i < tree_->topLevelItemCount(); ++i) Collect(tree_->topLevelItem(i), nodes);
  return nodes;
}

std::optional<core::LengthUnit> ImportDialog::ChosenUnit() const {
  const int id = unit_choices_->checkedId();
  return id < 0 ? std::nullopt : std::optional(static_cast<core::LengthUnit>(id));
}

void ImportDialog::Take() {
  if (preview_->asks_for_unit()) {
    StartReading(ChosenUnit());
  } else {
    emit Taken(*preview_, TickedNodes());
    accept();
  }
}

void ImportDialog::ShowState() {
  const auto ticked = static_cast<int>(TickedNodes().size());
  take_->setText(ticked == 0   ? tr("&Take")
                 : ticked == 1 ? tr("&Take 1 part")
                               : tr("&Take %1 parts").arg(ticked));
  const bool has_unit = preview_ && (!preview_->asks_for_unit() || ChosenUnit());
  take_->setEnabled(!is_reading() && ticked > 0 && has_unit);
  take_->setToolTip(take_->isEnabled() ? tr("Adds them to the layout, where the file has them")
                                       : tr("Tick what becomes a part first"));
  tree_->setEnabled(!is_reading());
  units_->setEnabled(!is_reading());
}

}  // namespace elbowroom::console
