//! MCAP files: channels of messages in packed chunks, with an index behind them (mcap.dev/spec, version 0).

use std::collections::BTreeMap;
use std::io::{self, Write};

const MAGIC: &[u8] = b"\x89MCAP0\r\n";
/// Fast: most of a chunk is pictures that are packed already.
const COMPRESSION: i32 = 1;

const HEADER: u8 = 1;
const FOOTER: u8 = 2;
const SCHEMA: u8 = 3;
const CHANNEL: u8 = 4;
const MESSAGE: u8 = 5;
const CHUNK: u8 = 6;
const MESSAGE_INDEX: u8 = 7;
const CHUNK_INDEX: u8 = 8;
const STATISTICS: u8 = 11;
const DATA_END: u8 = 15;

/// A file under way.
pub(crate) struct McapFile<W: Write> {
    writer: W,
    position: u64,
    /// Schemas and channels as records, in the order of their numbers.
    schemas: Vec<(String, Vec<u8>)>,
    channels: Vec<(String, Vec<u8>)>,
    messages: BTreeMap<u16, u64>,
    times_ns: Option<[u64; 2]>,
    chunk: Chunk,
    chunk_indices: Vec<Vec<u8>>,
}

#[derive(Default)]
struct Chunk {
    records: Vec<u8>,
    times_ns: Option<[u64; 2]>,
    /// Time and place of each channel's messages.
    places: BTreeMap<u16, Vec<[u64; 2]>>,
}

impl<W: Write> McapFile<W> {
    /// Begins the file.
    pub(crate) fn begin(writer: W) -> io::Result<Self> {
        let mut file = Self {
            writer,
            position: 0,
            schemas: Vec::new(),
            channels: Vec::new(),
            messages: BTreeMap::new(),
            times_ns: None,
            chunk: Chunk::default(),
            chunk_indices: Vec::new(),
        };
        file.write(MAGIC)?;
        let header = record(HEADER, &[text(""), text(concat!("trove ", env!("CARGO_PKG_VERSION")))].concat());
        file.write(&header)?;
        Ok(file)
    }

    /// The number of a channel for protobuf messages of a type; it appears with its first use.
    pub(crate) fn channel(&mut self, topic: &str, message: &str, descriptors: &[u8]) -> u16 {
        if let Some(known) = self.channels.iter().position(|(name, _)| name == topic) {
            return known as u16;
        }
        let schema = self.schemas.iter().position(|(name, _)| name == message).unwrap_or_else(|| {
            let number = self.schemas.len() as u16 + 1; // 0 is none
            let content = [&number.to_le_bytes()[..], &text(message), &text("protobuf"), &bytes(descriptors)].concat();
            self.schemas.push((message.to_owned(), record(SCHEMA, &content)));
            self.chunk.records.extend(&self.schemas[self.schemas.len() - 1].1);
            self.schemas.len() - 1
        });
        let (number, schema) = (self.channels.len() as u16, schema as u16 + 1);
        let content =
            [&number.to_le_bytes()[..], &schema.to_le_bytes(), &text(topic), &text("protobuf"), &bytes(&[])].concat();
        let channel = record(CHANNEL, &content);
        self.chunk.records.extend(&channel);
        self.channels.push((topic.to_owned(), channel));
        number
    }

    /// A message of a channel.
    pub(crate) fn message(&mut self, channel: u16, time_ns: u64, data: &[u8]) {
        let sequence = self.messages.entry(channel).or_default();
        let place = self.chunk.records.len() as u64;
        let content = [
            &channel.to_le_bytes()[..],
            &(*sequence as u32).to_le_bytes(),
            &time_ns.to_le_bytes(),
            &time_ns.to_le_bytes(),
            data,
        ];
        self.chunk.records.extend(record(MESSAGE, &content.concat()));
        *sequence += 1;
        self.chunk.places.entry(channel).or_default().push([time_ns, place]);
        for times_ns in [&mut self.times_ns, &mut self.chunk.times_ns] {
            let [first, last] = times_ns.unwrap_or([time_ns; 2]);
            *times_ns = Some([first.min(time_ns), last.max(time_ns)]);
        }
    }

    /// Packs what has come since the last chunk.
    pub(crate) fn end_chunk(&mut self) -> io::Result<()> {
        let Chunk { records, times_ns, places } = std::mem::take(&mut self.chunk);
        if records.is_empty() {
            return Ok(());
        }
        let packed = zstd::bulk::compress(&records, COMPRESSION)?;
        let times = times_ns.unwrap_or_default().map(u64::to_le_bytes).concat();
        let start = self.position;
        let content = [
            &times[..],
            &(records.len() as u64).to_le_bytes(),
            &crc32fast::hash(&records).to_le_bytes(),
            &text("zstd"),
            &(packed.len() as u64).to_le_bytes(),
            &packed,
        ];
        self.write(&record(CHUNK, &content.concat()))?;
        let length = self.position - start;
        let mut offsets = Vec::new();
        for (channel, mut places) in places {
            offsets.extend(channel.to_le_bytes());
            offsets.extend(self.position.to_le_bytes());
            places.sort_unstable();
            let entries = places.as_flattened().iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<u8>>();
            self.write(&record(MESSAGE_INDEX, &[&channel.to_le_bytes()[..], &bytes(&entries)].concat()))?;
        }
        let indices_length = self.position - start - length;
        let index = [
            &times[..],
            &start.to_le_bytes(),
            &length.to_le_bytes(),
            &bytes(&offsets),
            &indices_length.to_le_bytes(),
            &text("zstd"),
            &(packed.len() as u64).to_le_bytes(),
            &(records.len() as u64).to_le_bytes(),
        ];
        self.chunk_indices.push(record(CHUNK_INDEX, &index.concat()));
        Ok(())
    }

    /// Ends the file.
    pub(crate) fn end(mut self) -> io::Result<()> {
        self.end_chunk()?;
        self.write(&record(DATA_END, &0u32.to_le_bytes()))?;
        let start = self.position;
        let counts: Vec<u8> =
            self.messages.iter().flat_map(|(c, n)| [&c.to_le_bytes()[..], &n.to_le_bytes()].concat()).collect();
        let statistics = [
            &self.messages.values().sum::<u64>().to_le_bytes()[..],
            &(self.schemas.len() as u16).to_le_bytes(),
            &(self.channels.len() as u32).to_le_bytes(),
            &[0; 8], // attachments and metadata
            &(self.chunk_indices.len() as u32).to_le_bytes(),
            &self.times_ns.unwrap_or_default().map(u64::to_le_bytes).concat(),
            &bytes(&counts),
        ];
        let named = self.schemas.iter().chain(&self.channels).flat_map(|(_, record)| record);
        let mut summary: Vec<u8> = named.chain(self.chunk_indices.iter().flatten()).copied().collect();
        summary.extend(record(STATISTICS, &statistics.concat()));
        // The sum covers the summary and the footer up to itself.
        let footer = record(FOOTER, &[&start.to_le_bytes()[..], &[0; 8], &[0; 4]].concat());
        summary.extend(&footer[..footer.len() - 4]);
        let sum = crc32fast::hash(&summary).to_le_bytes();
        self.write(&summary)?;
        self.write(&sum)?;
        self.write(MAGIC)
    }

    fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.position += bytes.len() as u64;
        self.writer.write_all(bytes)
    }
}

fn record(kind: u8, content: &[u8]) -> Vec<u8> {
    [&[kind][..], &(content.len() as u64).to_le_bytes(), content].concat()
}

fn bytes(content: &[u8]) -> Vec<u8> {
    [&(content.len() as u32).to_le_bytes()[..], content].concat()
}

fn text(content: &str) -> Vec<u8> {
    bytes(content.as_bytes())
}
