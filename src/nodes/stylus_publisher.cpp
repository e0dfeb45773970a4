// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/stylus_publisher.h"

#include <geometry_msgs/WrenchStamped.h>
#include <std_msgs/Bool.h>

#include "nodes/conversions.h"

namespace viscera::nodes {

StylusPublisher::StylusPublisher(ros::NodeHandle& node, const StylusMailbox& mailbox, const std::string& tissue_frame,
                                 const std::string& frame_prefix)
    : mailbox_(mailbox), tissue_frame_(tissue_frame), tool_frame_(toolFrame(mailbox.config(), frame_prefix)) {
  const std::string body = mailbox.config().name + "/body/";
  force_ = node.advertise<geometry_msgs::WrenchStamped>(body + "servo_cf", 1);
  // A CRTK device takes a body wrench in its tip's frame unless told that it is in the frame of its poses.
  absolute_ = node.advertise<std_msgs::Bool>(body + "set_cf_orientation_absolute", 1, true);
  std_msgs::Bool absolute;
  absolute.data = true;
  absolute_.publish(absolute);
}

void StylusPublisher::publish(const Reaction& reaction, const StylusSample& sample, const ros::Time& stamp) {
  if (force_.getNumSubscribers() > 0) {
    const DeviceFrame frame = mailbox_.deviceFrame();
    const Reaction safe = sample.valid ? reaction : Reaction{};  // a hand that is not tracked must not be pushed
    force_.publish(toWrench(safe, frame.from_tissue, frame.name, stamp));
  }
  // The same stamp twice, as while /clock stands still, would make every tf2 listener warn.
  if (!sample.valid || stamp == last_transform_) return;
  last_transform_ = stamp;
  broadcaster_.sendTransform(toTransform(sample.pose, tissue_frame_, tool_frame_, stamp));
}

}  // namespace viscera::nodes
