"""Every container by a writer that is not ours: name -> (version of ROS, write(path, messages))."""
import lz4.frame
from mcap.writer import CompressionType
from mcap.writer import Writer as McapWriter
from rosbags.rosbag1 import Writer as Bag1
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin
from rosbags.rosbag2 import Writer as Bag2


def bag_of_ros1(compression, as_ros=True):
    """ROS' own library reads lz4 only as it writes it: independent blocks, a checksum, no size; rosbags 0.11.9 differs in all three."""


    def write(path, messages):
        path = path.with_suffix(".bag")
        writer = Bag1(path)
        if compression:
            writer.set_compression(compression)
        if compression == Bag1.CompressionFormat.LZ4 and as_ros:
            writer.compressor = lambda chunk: lz4.frame.compress(chunk, block_linked=False, store_size=False, content_checksum=True)
        with writer:
            topics = {}
            for topic, kind, ns, message in messages.all():
                if topic not in topics:
                    topics[topic] = writer.add_connection(topic, kind, typestore=messages.store)
                writer.write(topics[topic], ns, messages.serialized(kind, message))
        return path

    return 1, write


def rosbag2(storage, version=9, compression=None, little_endian=True):
    def write(path, messages):
        writer = Bag2(path, version=version, storage_plugin=storage)
        if compression:
            writer.set_compression(compression, CompressionFormat.ZSTD)
        with writer:
            topics = {}
            for topic, kind, ns, message in messages.all():
                if topic not in topics:
                    topics[topic] = writer.add_connection(topic, kind, typestore=messages.store)
                writer.write(topics[topic], ns, messages.serialized(kind, message, little_endian))
        return path

    return 2, write


def mcap(ros, compression=CompressionType.NONE, chunks=True, statistics=True):
    def write(path, messages):
        path = path.with_suffix(".mcap")
        with open(path, "wb") as stream:
            writer = McapWriter(stream, chunk_size=4000, compression=compression, use_chunking=chunks, use_statistics=statistics,
                                repeat_channels=statistics, repeat_schemas=statistics, enable_data_crcs=not chunks)
            writer.start(profile=f"ros{ros}")
            channels = {}
            for topic, kind, ns, message in messages.all():
                if topic not in channels:
                    name = kind if ros == 2 else kind.replace("/msg/", "/")
                    schema = writer.register_schema(name, f"ros{ros}msg", b"")
                    channels[topic] = writer.register_channel(topic, "ros1" if ros == 1 else "cdr", schema)
                writer.add_message(channels[topic], ns, messages.serialized(kind, message), ns)
            writer.finish()
        return path

    return ros, write


WRITERS = {
    "rosbags, bag": bag_of_ros1(None),
    "rosbags, bag, bz2": bag_of_ros1(Bag1.CompressionFormat.BZ2),
    "rosbags, bag, lz4": bag_of_ros1(Bag1.CompressionFormat.LZ4),
    "rosbags, SQLite": rosbag2(StoragePlugin.SQLITE3),
    "rosbags, SQLite, version 8": rosbag2(StoragePlugin.SQLITE3, version=8),
    "rosbags, SQLite, big endian": rosbag2(StoragePlugin.SQLITE3, little_endian=False),
    "rosbags, SQLite, messages by zstd": rosbag2(StoragePlugin.SQLITE3, compression=CompressionMode.MESSAGE),
    "rosbags, MCAP": rosbag2(StoragePlugin.MCAP),
    "rosbags, MCAP, storage by zstd": rosbag2(StoragePlugin.MCAP, compression=CompressionMode.STORAGE),
    "rosbags, MCAP, messages by zstd": rosbag2(StoragePlugin.MCAP, compression=CompressionMode.MESSAGE),
    **{f"mcap, ROS {ros}{name}": mcap(ros, **options)
       for ros in (1, 2)
       for name, options in {"": {}, ", lz4": {"compression": CompressionType.LZ4}, ", zstd": {"compression": CompressionType.ZSTD},
                             ", no chunks": {"chunks": False}, ", no statistics": {"statistics": False}}.items()},
}
# Name: (version of ROS, write), exit code, what is said.
REFUSED = {
    "rosbags, SQLite, files by zstd": (rosbag2(StoragePlugin.SQLITE3, compression=CompressionMode.FILE), 4,
                                       "files packed by zstd as a whole are not read"),
    "rosbags, bag, lz4 as rosbags makes it": (bag_of_ros1(Bag1.CompressionFormat.LZ4, as_ros=False), 3, "ROSLZ4_DATA_ERROR"),
}
