// The only source that includes ROS: its headers are heavy, and not of our standard of warnings.
#include "recordings/containers/ros1_store.hpp"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#include <rosbag/bag.h>
#include <rosbag/view.h>
#pragma GCC diagnostic pop

#include <map>

#include "cmap/core/array.hpp"
#include "cmap/core/execution.hpp"

namespace cmap {
namespace {

/// What the library throws, as what it means.
template <class Call>
auto translated(const std::string& place, Call&& call) {
  try {
    return call();
  } catch (const Error&) {
    throw;
  } catch (const rosbag::BagUnindexedException&) {
    throw InputError(place +
                     ": the bag is not indexed, as after a recording that did not end: `rosbag reindex` mends it");
  } catch (const std::bad_alloc&) {
    throw InputError(place + ": sizes that cannot be");
  } catch (const std::exception& error) {
    throw InputError(fmt::format("{}: {}", place, error.what()));
  }
}

class Ros1Store : public MessageStore {
 public:
  explicit Ros1Store(const std::filesystem::path& path) : name_(path.string()) {
    translated(name_, [&] {
      bag_.open(name_, rosbag::bagmode::Read);
      rosbag::View all(bag_);
      for (const rosbag::ConnectionInfo* connection : all.getConnections()) add(*connection);
      for (StoredTopic& topic : topics_) {
        topic.n_messages = rosbag::View(bag_, rosbag::TopicQuery(topic.name)).size();
      }
    });
  }

  const std::vector<StoredTopic>& topics() const override { return topics_; }

  void select(const std::vector<bool>& is_wanted) override {
    wanted_.clear();
    for (std::size_t i = 0; i < topics_.size(); ++i) {
      if (is_wanted[i]) wanted_.push_back(topics_[i].name);
    }
    is_selected_ = true;
  }

  bool next(StoredMessage& message) override {
    throw_if_stopped();
    return translated(place(), [&] {
      begin();
      if (at_ == view_->end()) return false;
      const rosbag::MessageInstance& instance = *at_;
      ++index_;
      data_.clear();
      data_.resize(instance.size());
      ros::serialization::OStream stream(reinterpret_cast<std::uint8_t*>(data_.data()),
                                         static_cast<std::uint32_t>(data_.size()));
      instance.write(stream);
      message = {topic_of_name_.at(instance.getTopic()), static_cast<std::int64_t>(instance.getTime().toNSec()), data_};
      ++at_;
      return true;
    });
  }

  std::string place() const override { return fmt::format("{}: message {} of those read", name_, index_); }

 private:
  void add(const rosbag::ConnectionInfo& connection) {
    const auto [place, is_new] = topic_of_name_.emplace(connection.topic, topics_.size());
    if (is_new) {
      topics_.push_back({connection.topic, connection.datatype, "ros1", 0});
    } else if (topics_[place->second].type != connection.datatype) {
      throw InputError(fmt::format("{}: topic {} has messages of {} and of {}", name_, connection.topic,
                                   topics_[place->second].type, connection.datatype));
    }
  }

  void begin() {
    if (view_) return;
    view_ = is_selected_ ? std::make_unique<rosbag::View>(bag_, rosbag::TopicQuery(wanted_))
                         : std::make_unique<rosbag::View>(bag_);
    at_ = view_->begin();
  }

  std::string name_;
  rosbag::Bag bag_;
  std::vector<StoredTopic> topics_;
  std::map<std::string, std::size_t> topic_of_name_;
  std::vector<std::string> wanted_;
  bool is_selected_ = false;
  std::unique_ptr<rosbag::View> view_;
  rosbag::View::iterator at_;
  Array<std::byte> data_;
  std::uint64_t index_ = 0;
};

}  // namespace

std::unique_ptr<MessageStore> open_ros1_bag(const std::filesystem::path& path) {
  return std::make_unique<Ros1Store>(path);
}

}  // namespace cmap
