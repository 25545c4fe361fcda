"""Makes the session files of this folder, as a Python program would write them: pip install mcap; python sessions.py"""

import struct

import zstandard
from mcap.records import Chunk
from mcap.writer import CompressionType, Writer

DAY = 86_400_000_000_000


def write(path, compression, frames=40, gap=0):
    """Frames at 30 Hz, the last one later by the gap (ns)."""
    with open(path, "wb") as file:
        writer = Writer(file, chunk_size=4096, compression=compression)
        writer.start(profile="toile", library="sessions.py")
        entries = {"version": "1", "origin": "toile", "name": "by python", "scale": "known"}
        writer.add_metadata("toile.session", entries)
        channels = []
        for topic in ["joints", "hands"]:
            schema = writer.register_schema(f"toile.{topic}/1", "text/plain", b"")
            channels.append(writer.register_channel(f"/{topic}", "toile-le", schema))
        for i in range(frames):
            time = i * 33_000_000 + (gap if i == frames - 1 else 0)
            joints = struct.pack("<QI", time, 23)
            for k in range(23):
                joints += struct.pack("<4f", k / 64, i / 64, 0.5, 1.0)
            hands = struct.pack("<QBB", time, i % 3, (i + 1) % 3)
            for channel, data in zip(channels, [joints, hands]):
                writer.add_message(channel, time, data, time)
        writer.finish()


def bomb(path, claimed, unpacked):
    """A chunk of zeros that says how large it is, and is another size."""
    data = zstandard.ZstdCompressor(level=19).compress(bytes(unpacked))
    chunk = Chunk("zstd", data, 0, 0, 0, claimed)
    with open(path, "wb") as file:
        writer = Writer(file, use_chunking=False)
        writer.start(profile="toile", library="sessions.py")
        chunk.write(writer._Writer__record_builder)
        writer.finish()


write("python-zstd.mcap", CompressionType.ZSTD)
write("python-lz4.mcap", CompressionType.LZ4)
write("gap.mcap", CompressionType.NONE, frames=3, gap=DAY)
bomb("bomb.mcap", 1000, 200 << 20)
bomb("large-bomb.mcap", 200 << 20, 200 << 20)
