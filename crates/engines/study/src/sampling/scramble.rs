//! Nested uniform scrambling of binary digits.

/// Levels of the tree of digits that one hash decides: a tree of six levels has 63 nodes, a word has 64 bits.
const LEVELS: u32 = 6;

/// A random permutation of the binary fractions that keeps every digital net a net: Owen's nested uniform scrambling.
///
/// A. B. Owen, "Randomly permuted (t,m,s)-nets and (t,s)-sequences", in: Monte Carlo and Quasi-Monte Carlo Methods in Scientific
/// Computing, Springer 1995: a digit is flipped or not by a coin of its own for every value of the digits before it. The coins are
/// bits of a hash of those digits, as in B. Burley, "Practical hash-based Owen scrambling", Journal of Computer Graphics Techniques
/// 9(4), 2020; but where Burley's hash only approximates the tree of coins, here every node of the tree has its own bit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Scramble {
    key: u64,
}

impl Scramble {
    /// The scramble of one dimension; different seeds and dimensions are independent.
    pub(super) fn new(seed: u64, dimension: u64) -> Self {
        Self { key: mixed(mixed(seed).wrapping_add(dimension)) }
    }

    /// Permutes the fraction whose first digit is bit 63. Digits beyond the 54th are cut off.
    pub(super) fn apply(self, fraction: u64) -> u64 {
        let mut flips = 0;
        for group in 0..54 / LEVELS {
            let done = LEVELS * group;
            // The marker bit makes the digits of different lengths different names.
            let prefix = if done == 0 { 1 } else { 1 << done | fraction >> (64 - done) };
            let coins = mixed(self.key ^ mixed(prefix));
            let digits = fraction << done >> (64 - LEVELS);
            // Node numbers as in a heap: the root is 1, the children of n are 2n and 2n + 1.
            for level in 0..LEVELS {
                let node = 1 << level | digits >> (LEVELS - level);
                flips = flips << 1 | (coins >> node & 1);
            }
        }
        (fraction ^ flips << 10) & !0x3FF
    }
}

/// A bijection of 64 bits in which each bit of the result depends on all of the argument.
///
/// `SplitMix64`: G. L. Steele, D. Lea, C. H. Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014, with the constants
/// of D. Stafford's variant 13.
pub(crate) fn mixed(x: u64) -> u64 {
    let x = x.wrapping_add(0x9E37_79B9_7F4A_7C15);
    let x = (x ^ x >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let x = (x ^ x >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
    x ^ x >> 31
}

#[cfg(test)]
mod tests {
    use super::*;

    /// First outputs of `SplitMix64` for the seed 1234567, as published with the reference implementation's test vectors.
    #[test]
    fn mixing_is_splitmix64() {
        let golden = 0x9E37_79B9_7F4A_7C15_u64;
        let seed = 1_234_567_u64;
        assert_eq!(mixed(seed), 6_457_827_717_110_365_317);
        assert_eq!(mixed(seed.wrapping_add(golden)), 3_203_168_211_198_807_973);
    }

    /// Two fractions that share exactly their first k digits still do after scrambling.
    #[test]
    fn shared_digits_stay_shared() {
        let mut x = 1;
        for round in 0..2000 {
            x = mixed(x);
            let shared = round % 54;
            let y = x ^ (1 << (63 - shared)) ^ (mixed(!x) >> shared >> 1);
            assert_eq!((x ^ y).leading_zeros(), shared);
            let scramble = Scramble::new(7, u64::from(round % 5));
            assert_eq!((scramble.apply(x) ^ scramble.apply(y)).leading_zeros(), shared);
        }
    }

    /// Every node has a fair coin of its own: over seeds, each digit is flipped half of the time, and digits at different nodes agree
    /// half of the time. 4096 tosses: standard deviation 32; the bound is five of them.
    #[test]
    fn coins_are_fair_and_independent() {
        let fractions = [0, 1 << 63, 0x5555 << 48, 0x5557 << 48];
        let flips: Vec<[u64; 4]> = (0..4096).map(|seed| fractions.map(|x| (Scramble::new(seed, 3).apply(x) ^ x) >> 10)).collect();
        let near_half = |count: usize| count.abs_diff(2048) <= 160;
        for digit in 0..54 {
            let flipped = |word: u64| word >> (53 - digit) & 1 == 1;
            assert!(near_half(flips.iter().filter(|f| flipped(f[2])).count()), "digit {digit}");
            if digit > 0 {
                assert!(near_half(flips.iter().filter(|f| flipped(f[0]) == flipped(f[1])).count()), "digit {digit}");
                let neighbour = |word: u64| word >> (54 - digit) & 1 == 1;
                assert!(near_half(flips.iter().filter(|f| flipped(f[2]) == neighbour(f[2])).count()), "digit {digit}");
            }
            // 0x5555 and 0x5557 differ first in their fifteenth digit.
            let same = flips.iter().filter(|f| flipped(f[2]) == flipped(f[3])).count();
            assert!(if digit <= 14 { same == 4096 } else { near_half(same) }, "digit {digit}: {same}");
        }
    }
}
