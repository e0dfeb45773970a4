# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Drivers of every kind in config/devices, modelled on their sources. Each gets the pose of a tip in the tissue frame,
computes what its device would measure there, and publishes it in its own messages, units and axes."""
import threading
import time

import genpy.dynamic
import rospy
from geometry_msgs.msg import Pose, PoseStamped, TransformStamped, Wrench, WrenchStamped
from haply_service import HaplyService
from program import Program, node
from sensor_msgs.msg import JointState, Joy
from tf2_msgs.msg import TFMessage
from turns import IDENTITY, plus, quaternion, times, transposed

VECTOR = "=" * 80 + "\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n"


def foreign(name, definition):
    """Returns a message of a package that is not installed, from its definition alone."""
    return genpy.dynamic.generate_dynamic(name, definition)[name]


OmniButtonEvent = foreign("omni_msgs/OmniButtonEvent", "int32 grey_button\nint32 white_button\n")
OmniFeedback = foreign("omni_msgs/OmniFeedback",
                       "geometry_msgs/Vector3 force\ngeometry_msgs/Vector3 position\n" + VECTOR)
DeviceFeedback = foreign("geomagic_control/DeviceFeedback",
                         "geometry_msgs/Vector3 force\ngeometry_msgs/Vector3 position\nbool[] lock\n" + VECTOR)

UP = ((1, 0, 0), (0, 0, -1), (0, 1, 0))  # from a haptic device's axes, y up, to ours, z up
DOWN = transposed(UP)
QUARTER = ((0, -1, 0), (1, 0, 0), (0, 0, 1))  # about z
JAWS = ((1, 0, 0), (0, -1, 0), (0, 0, -1))    # from a tool, z along its shaft, to the dVRK's tip, z along its jaws


def vector(v):
    return v.x, v.y, v.z


def fill(message, position, rotation):
    """Fills a geometry_msgs/Pose or Transform."""
    place = message.position if isinstance(message, Pose) else message.translation
    turn = message.orientation if isinstance(message, Pose) else message.rotation
    place.x, place.y, place.z = position
    turn.x, turn.y, turn.z, turn.w = quaternion(rotation)


class Driver:
    """Publishes, at a steady rate, a stylus with its tip at `at` (tissue frame, m), rotated by `turned` (3x3)."""
    rate_hz = 100
    profile, options, base = "crtk", [], (0, 0, 0)
    feels = True

    def __init__(self, stylus):
        self.stylus = stylus
        self.at, self.turned = None, IDENTITY
        self.force_n, self.forces = None, 0  # tissue frame
        self.down = [0, 0]
        self.open()
        self.ended = False
        threading.Thread(target=self.play, daemon=True).start()

    def device(self):
        return "%s=%s" % (self.stylus, self.profile)

    def play(self):
        while not rospy.is_shutdown() and not self.ended:
            at = self.at
            if at is not None:
                self.tell(plus(at, self.base, -1), self.turned)
            time.sleep(1 / self.rate_hz)

    def end(self):
        self.ended = True

    def joy(self, topic):
        return rospy.Publisher(topic, Joy, queue_size=10)

    def feel(self, force):
        self.force_n = force
        self.forces += 1


class Crtk(Driver):
    message, at_part = PoseStamped, "pose"

    def name(self):
        return self.stylus

    def open(self):
        name = self.name()
        self.poses = rospy.Publisher(name + "/measured_cp", self.message, queue_size=1, tcp_nodelay=True)
        self.buttons = [self.joy("%s/button%d" % (name, b)) for b in (1, 2)]
        rospy.Subscriber(name + "/body/servo_cf", WrenchStamped, lambda m: self.feel(vector(m.wrench.force)))

    def tell(self, position, rotation):
        message = self.message()
        message.header.stamp = rospy.Time.now()
        message.header.frame_id = "tissue"
        fill(getattr(message, self.at_part), position, rotation)
        self.poses.publish(message)

    def press(self, button, down):
        self.buttons[button - 1].publish(Joy(buttons=[int(down)]))


class Crtk2021(Crtk):
    profile = "crtk_2021"
    message, at_part = TransformStamped, "transform"

    def name(self):
        return "arm"

    def device(self):
        return self.stylus + "=crtk_2021:arm"


class DvrkMaster(Crtk):
    """Its gripper is the first button: closed is pressed. z of its poses points along the jaws."""
    profile = "dvrk_mtm"

    def device(self):
        return "%s=dvrk_mtm:%s" % (self.stylus, self.stylus)

    def open(self):
        super().open()
        self.gripper = rospy.Publisher(self.stylus + "/gripper/measured_js", JointState, queue_size=1)
        self.bicoag = self.joy("footpedals/bicoag")
        self.clutch = self.joy("footpedals/clutch")

    def tell(self, position, rotation):
        super().tell(position, times(rotation, JAWS))
        self.gripper.publish(JointState(name=["gripper"], position=[0.0 if self.down[0] else 0.5]))

    def press(self, button, down):
        self.down[button - 1] = int(down)
        if button == 2:
            self.bicoag.publish(Joy(buttons=[int(down)]))


class PhantomOmni(Driver):
    """omni_common: positions rotated to z up, in metres; orientations of the device, except for a quarter turn of the
    stylus; a frame that is known nowhere else; buttons in one message of omni_msgs."""
    profile, base = "phantom_omni", (0, -0.09, 0)

    def open(self):
        self.poses = rospy.Publisher("phantom/pose", PoseStamped, queue_size=1, tcp_nodelay=True)
        self.buttons = rospy.Publisher("phantom/button", OmniButtonEvent, queue_size=100)
        self.lock_mm = None
        rospy.Subscriber("phantom/force_feedback", OmniFeedback, self.felt)

    def felt(self, message):
        self.lock_mm = vector(message.position)
        self.feel(vector(message.force))

    def tell(self, position, rotation):
        device_m, device_turn = times(DOWN, position), times(DOWN, rotation)
        message = PoseStamped()
        message.header.stamp = rospy.Time.now()
        message.header.frame_id = "/map"
        x, y, z = device_m
        fill(message.pose, (x, -z, y), times(device_turn, transposed(QUARTER)))
        self.poses.publish(message)

    def press(self, button, down):
        self.down[button - 1] = int(down)
        self.buttons.publish(OmniButtonEvent(grey_button=self.down[0], white_button=self.down[1]))


class Geomagic(Driver):
    """ros_geomagic: millimetres, y up, no frame; both buttons in a Joy that comes with every pose."""
    profile, base = "geomagic", (0, -0.09, 0)

    def open(self):
        self.poses = rospy.Publisher("Geomagic/pose", PoseStamped, queue_size=1, tcp_nodelay=True)
        self.joys = self.joy("Geomagic/joy")
        self.lock_mm = None
        rospy.Subscriber("Geomagic/force_feedback", DeviceFeedback, self.felt)

    def felt(self, message):
        self.lock_mm = vector(message.position)
        self.feel(times(UP, vector(message.force)))

    def tell(self, position, rotation):
        message = PoseStamped()
        message.header.stamp = rospy.Time.now()
        fill(message.pose, [1000 * x for x in times(DOWN, position)], times(DOWN, rotation))
        self.poses.publish(message)
        self.joys.publish(Joy(axes=[0] * 6, buttons=self.down))

    def press(self, button, down):
        self.down[button - 1] = int(down)


class Tracker(Driver):
    """No forces, and a foot pedal for buttons."""
    feels = False

    def press(self, button, down):
        self.down[button - 1] = int(down)
        self.pedal.publish(Joy(buttons=self.down))


class Polhemus(Tracker):
    """A station in tf, with its base upside down on the ceiling: z down, y towards the other side."""
    profile = "polhemus"
    rate_hz = 120
    options = ["base.position_m=[0.1,0,0.3]"]
    base = (0.1, 0, 0.3)
    turn = ((1, 0, 0), (0, -1, 0), (0, 0, -1))

    def device(self):
        return "%s=polhemus:2" % self.stylus

    def open(self):
        self.frames = rospy.Publisher("/tf", TFMessage, queue_size=10, tcp_nodelay=True)
        self.pedal = self.joy(self.stylus + "/pedal")

    def tell(self, position, rotation):
        transform = TransformStamped()
        transform.header.stamp = rospy.Time.now()
        transform.header.frame_id = "polhemus_base"
        transform.child_frame_id = "polhemus_station_2"
        fill(transform.transform, times(self.turn, position), times(self.turn, rotation))
        self.frames.publish([transform])


class TfTracker(Polhemus):
    """A frame below one that tf connects to the tissue."""
    profile, options, base, turn = "tf", ["pose.tf_base=camera"], (0, 0, 0), IDENTITY
    camera, camera_turned = (0.2, 0.1, 0.4), IDENTITY  # in the tissue frame

    def device(self):
        return "%s=tf:scalpel" % self.stylus

    def open(self):
        super().open()
        self.buttons = [self.joy("%s/button%d" % (self.stylus, b)) for b in (1, 2)]

    def tell(self, position, rotation):
        stamp = rospy.Time.now()
        out = []
        camera, turned = self.camera, self.camera_turned
        seen = transposed(turned)
        for parent, child, place, turn in (
            ("tissue", "camera", camera, turned),
            ("camera", "scalpel", times(seen, plus(position, camera, -1)), times(seen, rotation))):
            transform = TransformStamped()
            transform.header.stamp, transform.header.frame_id, transform.child_frame_id = stamp, parent, child
            fill(transform.transform, place, turn)
            out.append(transform)
        self.frames.publish(out)

    def press(self, button, down):
        self.buttons[button - 1].publish(Joy(buttons=[int(down)]))


class Vicon(Tracker):
    profile = "vicon"
    options = ["pose.frame=tissue"]

    def device(self):
        return "%s=vicon:scalpel/blade" % self.stylus

    def open(self):
        self.poses = rospy.Publisher("vicon/scalpel/blade", TransformStamped, queue_size=1, tcp_nodelay=True)
        self.pedal = self.joy(self.stylus + "/pedal")

    def tell(self, position, rotation):
        message = TransformStamped()
        message.header.stamp = rospy.Time.now()
        message.header.frame_id, message.child_frame_id = "/world_of_vicon", "vicon/scalpel/blade"
        fill(message.transform, position, rotation)
        self.poses.publish(message)


class OptiTrack(Tracker):
    profile = "optitrack"
    options = ["pose.frame=tissue", "tip.position_m=[0,0,-0.12]"]
    tip = (0, 0, -0.12)

    def device(self):
        return "%s=optitrack:pointer" % self.stylus

    def open(self):
        self.poses = rospy.Publisher("pointer/pose", PoseStamped, queue_size=1, tcp_nodelay=True)
        self.pedal = self.joy(self.stylus + "/pedal")

    def tell(self, position, rotation):
        message = PoseStamped()
        message.header.stamp = rospy.Time.now()
        fill(message.pose, plus(position, times(rotation, self.tip), -1), rotation)
        self.poses.publish(message)


class BarePose(Driver):
    profile = "pose"

    def open(self):
        self.poses = rospy.Publisher(self.stylus + "/pose", Pose, queue_size=1, tcp_nodelay=True)
        self.joys = self.joy(self.stylus + "/joy")
        rospy.Subscriber(self.stylus + "/wrench", Wrench, lambda m: self.feel(vector(m.force)))

    def tell(self, position, rotation):
        message = Pose()
        fill(message, position, rotation)
        self.poses.publish(message)

    def press(self, button, down):
        self.down[button - 1] = int(down)
        self.joys.publish(Joy(buttons=self.down))


class HaplyInverse3(Driver):
    """haply_bridge with a simulated service. y of the grip points away from the user, as -z of a tool does."""
    profile, base = "haply_inverse3", (0, 0.03, -0.15)
    to_grip = transposed(UP)

    def open(self):
        self.service = HaplyService()
        self.bridge = Program([node("haply_bridge"), "_port:=%d" % self.service.port])

    def tell(self, position, rotation):
        self.service.at, self.service.grip = position, quaternion(times(rotation, self.to_grip))
        if self.service.force is not None:
            self.feel(self.service.force)

    def press(self, button, down):
        self.service.buttons[button - 1] = bool(down)

    def end(self):
        super().end()
        self.bridge.end()
        self.service.stop()


KINDS = [Crtk, Crtk2021, DvrkMaster, PhantomOmni, Geomagic, Polhemus, TfTracker, Vicon, OptiTrack, BarePose, HaplyInverse3]

