"""`trove export --format mcap`: mcap and its protobuf support decode every message."""

import io
from collections import Counter

import numpy as np
import pytest
from exports import exported, sources
from PIL import Image


def test_every_message_is_decoded_and_says_what_the_frames_say(finished, tmp_path):
    reader = pytest.importorskip("mcap.reader")
    decoder = pytest.importorskip("mcap_protobuf.decoder")
    out, _ = exported(finished, tmp_path / "out", "mcap")
    frames = {(frame.table["view"], frame.table["time_ns"]): frame for frame in sources(finished)}
    (path,) = out.glob("train/*.mcap")
    kinds, seen = Counter(), set()
    with path.open("rb") as file:
        opened = reader.make_reader(file, decoder_factories=[decoder.DecoderFactory()], validate_crcs=True)
        summary = opened.get_summary()
        for schema, channel, message, decoded in opened.iter_decoded_messages():
            kinds[schema.name] += 1
            if not hasattr(decoded, "frame_id"):
                continue
            frame = frames[decoded.frame_id, message.log_time]
            time = decoded.timestamp
            assert time.seconds * 10**9 + time.nanos == message.log_time
            seen.add((decoded.frame_id, message.log_time))
            if schema.name == "foxglove.CompressedImage":
                found = np.array(Image.open(io.BytesIO(decoded.data)))
                name = channel.topic.rsplit("/", 1)[1]
                assert decoded.format == "png"
                assert (found == frame.picture("rgb" if name == "image" else name)).all()
            elif schema.name == "foxglove.RawImage":
                found = np.frombuffer(decoded.data, np.float32).reshape(decoded.height, decoded.width)
                assert decoded.encoding == "32FC1" and decoded.step == 4 * decoded.width
                assert (found == frame.depth_m()).all()
            else:
                assert np.allclose(np.reshape(decoded.K, (3, 3)), frame.table["intrinsics"])
                assert np.allclose(np.reshape(decoded.P, (3, 4))[:, :3], frame.table["intrinsics"])
    assert seen == set(frames)
    assert sum(kinds.values()) == summary.statistics.message_count
    moments = {frame.table["keyframe"] for frame in frames.values()}
    assert len(summary.chunk_indexes) == len(moments) == kinds["foxglove.SceneUpdate"]
    assert kinds["foxglove.CompressedImage"] == 3 * len(frames)
    assert kinds["foxglove.ImageAnnotations"] == kinds["foxglove.CameraCalibration"] == len(frames)


def test_boxes_and_cameras_stand_where_the_frames_put_them(finished, tmp_path):
    reader = pytest.importorskip("mcap.reader")
    decoder = pytest.importorskip("mcap_protobuf.decoder")
    out, _ = exported(finished, tmp_path / "out", "mcap")
    frames = sources(finished)
    (path,) = out.glob("train/*.mcap")
    boxes, cameras, outlines = {}, {}, {}
    with path.open("rb") as file:
        opened = reader.make_reader(file, decoder_factories=[decoder.DecoderFactory()])
        for schema, channel, message, decoded in opened.iter_decoded_messages():
            if schema.name == "foxglove.SceneUpdate":
                assert [deletion.type for deletion in decoded.deletions] == [1]
                boxes |= {(message.log_time, entity.id): entity for entity in decoded.entities}
            elif schema.name == "foxglove.FrameTransform":
                cameras[decoded.child_frame_id, message.log_time] = decoded
            elif schema.name == "foxglove.ImageAnnotations":
                outlines[channel.topic, message.log_time] = decoded
    for frame in frames:
        table = frame.table
        camera = cameras[table["view"], table["time_ns"]]
        place = [camera.translation.x, camera.translation.y, camera.translation.z]
        assert np.allclose(place, table["world_from_camera_translation_m"])
        rotation = [camera.rotation.w, camera.rotation.x, camera.rotation.y, camera.rotation.z]
        assert abs(np.dot(rotation, table["world_from_camera_rotation_wxyz"])) == pytest.approx(1)
        visible = [row for row in frame.users if row["visible_box"]]
        drawn = outlines[f"/{table['view'].replace('.', '/')}/annotations", table["time_ns"]].points
        assert len(drawn) == len(visible)
        for row, outline in zip(visible, drawn):
            corners = np.array([[point.x, point.y] for point in outline.points])
            assert [*corners.min(0), *(corners.max(0) - 1)] == row["visible_box"]
        for row in frame.users:
            (cube,) = boxes[table["keyframe_time_ns"], str(row["id"])].cubes
            assert np.allclose([cube.size.x, cube.size.y, cube.size.z], row["size_m"])
            place = [cube.pose.position.x, cube.pose.position.y, cube.pose.position.z]
            assert np.allclose(place, np.array(row["world_from_body"])[:3, 3])
