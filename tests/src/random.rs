//! Random numbers that are the same on every machine, for meshes and rays that a seed must
//! reproduce.

/// The splitmix64 generator (G. Steele, D. Lea, C. Flood, *Fast splittable pseudorandom number
/// generators*, 2014).
#[derive(Clone, Debug)]
#[expect(missing_copy_implementations, reason = "a copy would repeat the numbers unnoticed")]
pub struct SplitMix64(pub u64);

impl SplitMix64 {
    /// 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number in 0..n, n > 0; biased by less than n / 2^64.
    pub fn below(&mut self, n: u64) -> u64 {
        ((u128::from(self.bits()) * u128::from(n)) >> 64) as u64
    }

    /// A number from low to high, both included and less than 2^62 in size.
    pub fn within(&mut self, [low, high]: [i64; 2]) -> i64 {
        low + self.below((high - low) as u64 + 1) as i64
    }

    /// Either, evenly.
    pub fn coin(&mut self) -> bool {
        self.bits() >> 63 == 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_splitmix64() {
        // The first outputs for seed 1234567 of the authors' reference in C.
        let mut random = SplitMix64(1_234_567);
        let expected = [6_457_827_717_110_365_317, 3_203_168_211_198_807_973, 9_817_491_932_198_370_423];
        assert_eq!([(); 3].map(|()| random.bits()), expected);
    }

    #[test]
    fn ranges_include_their_ends_and_nothing_more() {
        let mut random = SplitMix64(1);
        let mut seen = [0; 5];
        for _ in 0..1000 {
            seen[(random.within([-2, 2]) + 2) as usize] += 1;
        }
        assert!(seen.iter().all(|&n| n > 100), "{seen:?}");
    }
}
