//! The hybrid of run lengths and bit packing, in which levels, indices into dictionaries and bools are written.

use super::fault::Fault;

/// Numbers of a fixed width in bits, as runs of the same one.
pub(super) struct Runs {
    bytes: Vec<u8>,
    at: usize,
    width: u32,
    now: Run,
}

#[derive(Clone, Copy)]
enum Run {
    /// So many of the same number are left.
    Same { value: u32, left: usize },
    /// So many numbers are left, packed from a bit on.
    Packed { bit: usize, left: usize },
}

impl Runs {
    /// Of numbers of at most 32 bits.
    pub(super) fn new(bytes: Vec<u8>, width: u32) -> Result<Self, Fault> {
        if width > 32 {
            return Err(Fault::new("numbers of at most 32 bits", format!("{width} bits")));
        }
        Ok(Self { bytes, at: 0, width, now: Run::Same { value: 0, left: 0 } })
    }

    /// One number, so often as it is wanted.
    pub(super) fn constant(value: u32) -> Self {
        Self { bytes: Vec::new(), at: 0, width: 0, now: Run::Same { value, left: usize::MAX } }
    }

    /// The next number, and how often it stands there at least, up to `most`.
    pub(super) fn peek(&mut self, most: usize) -> Result<(u32, usize), Fault> {
        loop {
            match self.now {
                Run::Same { left: 0, .. } | Run::Packed { left: 0, .. } => self.next_run()?,
                Run::Same { value, left } => return Ok((value, left.min(most))),
                Run::Packed { bit, left } => {
                    let value = self.packed(bit)?;
                    let mut count = 1;
                    while count < left.min(most) && self.packed(bit + count * self.width as usize)? == value {
                        count += 1;
                    }
                    return Ok((value, count));
                }
            }
        }
    }

    /// Moves on by what was seen.
    pub(super) fn pass(&mut self, count: usize) {
        match &mut self.now {
            Run::Same { left, .. } => *left = left.saturating_sub(count),
            Run::Packed { bit, left } => {
                *bit += count * self.width as usize;
                *left = left.saturating_sub(count);
            }
        }
    }

    fn next_run(&mut self) -> Result<(), Fault> {
        let mut head = 0u64;
        for shift in (0..35).step_by(7) {
            let byte = *self.bytes.get(self.at).ok_or_else(ended)?;
            self.at += 1;
            head |= u64::from(byte & 0x7f) << shift;
            if byte < 0x80 {
                break;
            }
        }
        let count = usize::try_from(head >> 1).map_err(|_| ended())?;
        if count == 0 {
            return Err(Fault::new("a run of numbers", "one of none"));
        }
        if head & 1 == 1 {
            // Groups of eight. The last one may be cut off behind the page's last number.
            self.now = Run::Packed { bit: self.at * 8, left: count.saturating_mul(8) };
            let bytes = count.saturating_mul(self.width as usize);
            self.at = self.at.saturating_add(bytes).min(self.bytes.len());
        } else {
            let bytes = self.width.div_ceil(8) as usize;
            let value = self.bytes.get(self.at..self.at + bytes).ok_or_else(ended)?;
            let value = value.iter().rev().fold(0, |value, byte| value << 8 | u32::from(*byte));
            self.now = Run::Same { value, left: count };
            self.at += bytes;
        }
        Ok(())
    }

    fn packed(&self, bit: usize) -> Result<u32, Fault> {
        let last = (bit + self.width as usize).div_ceil(8);
        let bytes = self.bytes.get(bit / 8..last).ok_or_else(ended)?;
        let word = bytes.iter().rev().fold(0u64, |word, byte| word << 8 | u64::from(*byte));
        let mask = (1u64 << self.width) - 1;
        Ok((word >> (bit % 8) & mask) as u32)
    }
}

fn ended() -> Fault {
    Fault::new("more numbers", "the end of a page")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(bytes: &[u8], width: u32, count: usize) -> Result<Vec<u32>, Fault> {
        let (mut runs, mut numbers) = (Runs::new(bytes.to_vec(), width)?, Vec::new());
        while numbers.len() < count {
            let (value, repeated) = runs.peek(count - numbers.len())?;
            runs.pass(repeated);
            numbers.extend(std::iter::repeat_n(value, repeated));
        }
        Ok(numbers)
    }

    #[test]
    fn the_specifications_example_is_read() {
        // 0 to 7 in three bits each, then four times 5.
        let bytes = [0b11, 0b1000_1000, 0b1100_0110, 0b1111_1010, 4 << 1, 5];
        assert_eq!(all(&bytes, 3, 12).unwrap(), [0, 1, 2, 3, 4, 5, 6, 7, 5, 5, 5, 5]);
        assert!(all(&bytes, 3, 13).is_err() && all(&[0], 3, 1).is_err() && Runs::new(Vec::new(), 33).is_err());
        assert_eq!(all(&[8 << 1], 0, 8).unwrap(), [0; 8]);
        assert!(all(&[0xff; 8], 32, 1).is_err());
    }
}
