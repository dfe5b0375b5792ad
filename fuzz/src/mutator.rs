//! Damage: what breaks readers, drawn from a seed.

/// Numbers at the ends of what fits.
const NUMBERS: [i64; 14] =
    [0, 1, -1, 7, 127, 128, 255, 256, 32_767, 65_535, i32::MAX as i64, u32::MAX as i64, i64::MAX, i64::MIN];
/// Words that texts may hold in place of numbers.
const WORDS: [&[u8]; 14] = [
    b"0",
    b"-1",
    b"1e308",
    b"-1e308",
    b"1e-320",
    b"nan",
    b"NaN",
    b"inf",
    b"4294967295",
    b"18446744073709551616",
    b"\"\"",
    b"null",
    b"[]",
    b"{}",
];
/// Longest input, bytes.
pub const LONGEST: usize = 1 << 20;

/// SplitMix64 (Steele, Lea and Flood 2014).
#[derive(Clone, Debug)]
pub struct Draw(u64);

impl Draw {
    /// From a seed.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// Any number.
    pub fn any(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number below `n`, which is not 0.
    pub fn below(&mut self, n: usize) -> usize {
        (self.any() % n as u64) as usize
    }
}

/// One of `inputs` with a few changes; `inputs` are not empty.
pub fn mutated(inputs: &[Vec<u8>], draw: &mut Draw) -> Vec<u8> {
    let mut data = inputs[draw.below(inputs.len())].clone();
    // Mostly few changes: many leave nothing that a reader recognises.
    let most = 1 << draw.below(5);
    let changes = 1 + draw.below(most);
    for _ in 0..changes {
        change(&mut data, inputs, draw);
    }
    data.truncate(LONGEST);
    data
}

fn change(data: &mut Vec<u8>, inputs: &[Vec<u8>], draw: &mut Draw) {
    if data.is_empty() {
        data.push(draw.any() as u8);
        return;
    }
    let at = draw.below(data.len());
    let most = 1 << draw.below(12);
    let length = 1 + draw.below((data.len() - at).min(most));
    match draw.below(12) {
        0 => data[at] ^= 1 << draw.below(8),
        1 => data[at] = draw.any() as u8,
        2 => put(data, at, &NUMBERS[draw.below(NUMBERS.len())].to_le_bytes()[..1 << draw.below(4)]),
        3 => {
            let big = NUMBERS[draw.below(NUMBERS.len())].to_be_bytes();
            put(data, at, &big[8 - (1 << draw.below(4))..]);
        }
        4 => drop(data.drain(at..at + length)),
        5 => {
            let piece = data[at..at + length].to_vec();
            let to = draw.below(data.len() + 1);
            data.splice(to..to, piece);
        }
        6 => {
            // The same again and again.
            let piece = data[at..at + length.min(64)].to_vec();
            let times = 1 << draw.below(10);
            data.splice(at..at, piece.repeat(times));
        }
        7 => {
            let other = &inputs[draw.below(inputs.len())];
            if !other.is_empty() {
                let from = draw.below(other.len());
                let length = 1 + draw.below(other.len() - from);
                data.splice(at..at, other[from..from + length].iter().copied());
            }
        }
        8 => data.truncate(at),
        9 | 10 => replace_number(data, at, draw),
        _ => {
            let word = WORDS[draw.below(WORDS.len())];
            let end = (at + length.min(8)).min(data.len());
            data.splice(at..end, word.iter().copied());
        }
    }
    // Texts that grow and grow are slow without being new.
    data.truncate(LONGEST);
}

/// Overwrites what is there.
fn put(data: &mut [u8], at: usize, bytes: &[u8]) {
    let end = (at + bytes.len()).min(data.len());
    data[at..end].copy_from_slice(&bytes[..end - at]);
}

/// Puts another number in the place of the next one in a text.
fn replace_number(data: &mut Vec<u8>, at: usize, draw: &mut Draw) {
    let Some(start) = data[at..].iter().position(u8::is_ascii_digit).map(|i| at + i) else { return };
    let is_part = |b: &&u8| b.is_ascii_digit() || matches!(b, b'.' | b'e' | b'-');
    let end = start + data[start..].iter().take_while(is_part).count();
    let word = match draw.below(3) {
        0 => WORDS[draw.below(WORDS.len())].to_vec(),
        1 => NUMBERS[draw.below(NUMBERS.len())].to_string().into_bytes(),
        _ => (draw.any() % 1000).to_string().into_bytes(),
    };
    data.splice(start..end, word);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_same_seed_gives_the_same_damage() {
        let inputs = [b"[drive] 12".to_vec(), Vec::new()];
        let damage = |seed| {
            let mut draw = Draw::new(seed);
            (0..1000).map(|_| mutated(&inputs, &mut draw)).collect::<Vec<_>>()
        };
        assert_eq!(damage(1), damage(1));
        assert_ne!(damage(1), damage(2));
        assert!(damage(1).iter().all(|data| data.len() <= LONGEST));
    }
}
