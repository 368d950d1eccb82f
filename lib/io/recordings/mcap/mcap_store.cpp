#include "recordings/mcap/mcap_store.hpp"

#include <algorithm>
#include <numeric>

#include "recordings/mcap/mcap_run.hpp"

namespace cmap {
namespace {

class McapStore : public MessageStore {
 public:
  explicit McapStore(std::unique_ptr<ByteSource> source) : source_(std::move(source)) {
    layout_ = mcap::read_layout(*source_);
    count_messages();
    list_topics();
    std::ranges::stable_sort(layout_.runs, {}, &mcap::Run::first_ns);
  }

  const std::vector<StoredTopic>& topics() const override { return topics_; }
  void select(const std::vector<bool>& is_wanted) override { is_wanted_ = is_wanted; }

  bool next(StoredMessage& message) override {
    if (last_ != nullptr) last_->pop();
    last_ = nullptr;
    for (;;) {
      std::erase_if(open_, [&](auto& run) { return run->is_done() && recycle(run); });
      mcap::OpenRun* first = earliest();
      if (must_open_another(first)) {
        open_next();
      } else if (first == nullptr) {
        if (!layout_.fault.empty()) source_->fail("{}", layout_.fault);
        return false;
      } else if (const std::size_t topic = topic_of(first->front().channel); is_wanted(topic)) {
        message = {topic, first->front().log_time_ns, first->front().data};
        last_ = first;
        return true;
      } else {
        first->pop();
      }
    }
  }

  std::string place() const override {
    if (last_ == nullptr) return source_->name();
    const mcap::Run& run = last_->run();
    if (!run.is_chunk) return fmt::format("{}: byte {}", source_->name(), run.begin + last_->front().place);
    return fmt::format("{}: byte {} of the chunk at byte {}", source_->name(), last_->front().place, run.begin);
  }

 private:
  /// Numbers of messages: as the statistics say, where channels and schemas are known; else by looking into chunks.
  void count_messages() {
    const auto is_known = [&](const auto& count) {
      const auto channel = layout_.channels.by_id.find(count.first);
      return channel != layout_.channels.by_id.end() &&
             (channel->second.schema == 0 || layout_.channels.type_of_schema.contains(channel->second.schema));
    };
    if (layout_.statistics && !layout_.statistics->empty() && std::ranges::all_of(*layout_.statistics, is_known)) {
      counts_ = *layout_.statistics;
      return;
    }
    counts_ = layout_.messages;
    mcap::OpenRun chunk;
    for (const mcap::Run& run : layout_.runs) {
      if (!run.is_chunk) continue;
      try {
        chunk.open(*source_, run, layout_.channels);
      } catch (const InputError&) {
        // Where its messages are due, it is an error; if no channel is known by then, it is one now.
        if (layout_.channels.by_id.empty()) throw;
        return;
      }
      for (const mcap::Entry& entry : chunk.entries()) ++counts_[entry.channel];
    }
  }

  void list_topics() {
    for (const auto& [id, channel] : layout_.channels.by_id) {
      const StoredTopic topic{channel.topic, layout_.channels.type_of(channel), channel.message_encoding, 0};
      const auto known = std::ranges::find(topics_, topic.name, &StoredTopic::name);
      if (known == topics_.end()) {
        topic_of_channel_[id] = topics_.size();
        topics_.push_back(topic);
      } else {
        if (known->type != topic.type || known->encoding_name != topic.encoding_name) {
          source_->fail("two channels of topic {} with messages of {} ({}) and {} ({})", topic.name, known->type,
                        known->encoding_name, topic.type, topic.encoding_name);
        }
        topic_of_channel_[id] = static_cast<std::size_t>(known - topics_.begin());
      }
      topics_[topic_of_channel_[id]].n_messages += counts_[id];
    }
  }

  /// Of a channel that statistics did not know of, and a damaged chunk hid, nobody can have asked for.
  std::size_t topic_of(std::uint16_t channel) const {
    const auto found = topic_of_channel_.find(channel);
    return found == topic_of_channel_.end() ? topics_.size() : found->second;
  }
  bool is_wanted(std::size_t topic) const {
    return topic < topics_.size() && (is_wanted_.empty() || is_wanted_[topic]);
  }

  mcap::OpenRun* earliest() {
    mcap::OpenRun* first = nullptr;
    for (const auto& run : open_) {
      const auto key = [](const mcap::OpenRun& r) { return std::pair(r.front().log_time_ns, r.run().begin); };
      if (first == nullptr || key(*run) < key(*first)) first = run.get();
    }
    return first;
  }

  /// The next run's messages may come first. Where too many overlap to be held, they come as they stand in the file.
  bool must_open_another(const mcap::OpenRun* first) const {
    constexpr std::size_t kMostBytes = std::size_t{1} << 28;
    if (next_run_ == layout_.runs.size()) return false;
    if (first == nullptr) return true;
    const auto held = std::accumulate(open_.begin(), open_.end(), std::size_t{0},
                                      [](std::size_t sum, const auto& run) { return sum + run->bytes(); });
    return layout_.runs[next_run_].first_ns <= first->front().log_time_ns && held < kMostBytes;
  }

  void open_next() {
    std::unique_ptr<mcap::OpenRun> run = spare_ ? std::move(spare_) : std::make_unique<mcap::OpenRun>();
    run->open(*source_, layout_.runs[next_run_++], layout_.channels);
    open_.push_back(std::move(run));
  }

  bool recycle(std::unique_ptr<mcap::OpenRun>& run) {
    spare_ = std::move(run);
    return true;
  }

  std::unique_ptr<ByteSource> source_;
  mcap::Layout layout_;
  std::map<std::uint16_t, std::uint64_t> counts_;
  std::vector<StoredTopic> topics_;
  std::map<std::uint16_t, std::size_t> topic_of_channel_;
  std::vector<bool> is_wanted_;
  std::size_t next_run_ = 0;
  std::vector<std::unique_ptr<mcap::OpenRun>> open_;
  std::unique_ptr<mcap::OpenRun> spare_;
  mcap::OpenRun* last_ = nullptr;
};

}  // namespace

std::unique_ptr<MessageStore> open_mcap(std::unique_ptr<ByteSource> source) {
  return std::make_unique<McapStore>(std::move(source));
}

}  // namespace cmap
