use super::*;

/// Numbers with difficult roundings, including −0, infinity, a subnormal number and large numbers.
const NUMBERS: [f64; 8] = [1.0 / 3.0, -0.0, 1e300, -7.1e-310, f64::INFINITY, 2.5, -1.0 / 7.0, 1e16];

/// Returns the bits of a result; zero for NaN, whose bits are unspecified.
fn bits(value: f64) -> u64 {
    if value.is_nan() { 0 } else { value.to_bits() }
}

/// Kernel that appends the results of operations with four lanes, as bits.
struct FourLaneBits<'a>(&'a mut Vec<u64>);

impl FourKernel for FourLaneBits<'_> {
    fn run<L: FourLanes>(self, lanes: L) {
        for (at, &a) in NUMBERS.iter().enumerate() {
            for &b in &NUMBERS {
                let one = SimdPack::four(lanes, [a, b, 0.1 * a, 3.0 * b]);
                let two = SimdPack::four(lanes, [b, a + 0.1, b, NUMBERS[(at + 3) % 8]]);
                let sums = SimdPack::sums([one, two, one * two, one - two]);
                self.0.extend([one, two, -one, one * 0.3].iter().flat_map(|four| four.values()).chain(sums).map(bits));
            }
        }
    }
}

/// Kernel that appends the results of every operation on every pair of numbers, as bits.
struct AllPairBits<'a>(&'a mut Vec<u64>);

impl Kernel for AllPairBits<'_> {
    type Output = ();

    fn run<L: Lanes>(self, lanes: L) {
        let pairs: Vec<(f64, f64)> = NUMBERS.iter().flat_map(|&a| NUMBERS.map(|b| (a, b))).collect();
        let mut rows: [Vec<u64>; 12] = Default::default();
        for pairs in pairs.chunks(L::WIDTH) {
            let [mut a, mut b] = [[0.0; WIDEST]; 2];
            pairs.iter().enumerate().for_each(|(lane, &pair)| (a[lane], b[lane]) = pair);
            let [one, two] = [SimdPack::load(lanes, &a), SimdPack::load(lanes, &b)];
            let less = one.below(two);
            let operations = [
                one + two,
                one - two,
                one * two,
                one / two,
                -one,
                one.sqrt(),
                one * 0.3,
                one + 0.7,
                one - 1.1,
                one.at_least(two),
                SimdPack::choose(less, one.like(1.0), one.like(0.0)),
            ];
            assert_eq!(one.anywhere(less), less.bits() != 0);
            for (row, wide) in rows.iter_mut().zip(operations) {
                row.extend(wide.store()[..pairs.len()].iter().map(|&value| bits(value)));
            }
            rows[11].extend((0..pairs.len()).map(|lane| u64::from(less.bits() >> lane & 1)));
        }
        self.0.extend(rows.concat());
    }
}

/// Kernel that loads quads into registers and stores them again.
struct QuadCopies<'a>(&'a [Quad], &'a [usize]);

impl Kernel for QuadCopies<'_> {
    type Output = Vec<(Quad, Quad)>;

    fn run<L: Lanes>(self, lanes: L) -> Self::Output {
        let mut all = Vec::new();
        for at in self.1.chunks(L::WIDTH) {
            let mut places = [0; WIDEST];
            places[..at.len()].copy_from_slice(at);
            let registers = lanes.gather(self.0.as_chunks::<1>().0, 0, &places);
            let columns = registers.map(|register| lanes.store(register));
            let back = lanes.quads(registers);
            all.extend((0..L::WIDTH).map(|lane| (Quad(columns.map(|column| column[lane])), back[lane])));
        }
        all
    }
}

#[test]
fn every_operation_leaves_the_same_bits_on_all_paths() {
    let mut expected = [Vec::new(), Vec::new()];
    Processor::Portable.run_by_four(FourLaneBits(&mut expected[0]));
    Processor::Portable.run(AllPairBits(&mut expected[1]));
    assert_eq!(expected.each_ref().map(Vec::len), [64 * 20, 64 * 12]);
    for path in Processor::all() {
        let mut found = [Vec::new(), Vec::new()];
        path.run_by_four(FourLaneBits(&mut found[0]));
        path.run(AllPairBits(&mut found[1]));
        assert!(found == expected, "{}", path.name());
    }
}

#[test]
fn quads_are_turned_and_turned_back() {
    let table: Vec<Quad> = (0..20).map(|row| Quad([0.0, 0.1, 0.2, 0.3].map(|at| f64::from(row) + at))).collect();
    let at = [3, 19, 0, 7, 7, 11, 2, 5, 18, 1, 4, 9, 9, 9, 16, 0];
    let expected: Vec<_> = at.iter().map(|&at| (table[at], table[at])).collect();
    for path in Processor::all() {
        assert_eq!(path.run(QuadCopies(&table, &at)), expected, "{}", path.name());
    }
}

/// Kernel that computes differences of quads.
struct QuadDifferences<'a>(&'a [Quad], &'a [usize]);

impl Kernel for QuadDifferences<'_> {
    type Output = Vec<[f64; 4]>;

    fn run<L: Lanes>(self, lanes: L) -> Self::Output {
        let mut all = Vec::new();
        for at in self.1.chunks(L::WIDTH) {
            let (mut from, mut to) = ([0; WIDEST], [0; WIDEST]);
            from[..at.len()].copy_from_slice(at);
            to[..at.len()].copy_from_slice(&at.iter().map(|place| 19 - place).collect::<Vec<_>>());
            let columns = lanes.between(self.0.as_chunks::<1>().0, 0, &from, &to).map(|register| lanes.store(register));
            all.extend((0..L::WIDTH).map(|lane| columns.map(|column| column[lane])));
        }
        all
    }
}

#[test]
fn quads_are_taken_from_others_and_their_fourth_numbers_are_added() {
    let table: Vec<Quad> = (0..20).map(|row| Quad([0.0, 0.1, 0.2, 0.3].map(|at| f64::from(row) + at))).collect();
    let at = [3, 19, 0, 7, 7, 11, 2, 5, 18, 1, 4, 9, 9, 9, 16, 0];
    let expected_quad = |&at: &usize| {
        let (from, to) = (table[at].0, table[19 - at].0);
        [to[0] - from[0], to[1] - from[1], to[2] - from[2], to[3] + from[3]]
    };
    let expected: Vec<_> = at.iter().map(expected_quad).collect();
    for path in Processor::all() {
        assert_eq!(path.run(QuadDifferences(&table, &at)), expected, "{}", path.name());
    }
}

/// Kernel that packs integers by all patterns of eight bits.
struct PackedIntegers;

impl Kernel for PackedIntegers {
    type Output = Vec<Vec<u32>>;

    fn run<L: Lanes>(self, lanes: L) -> Self::Output {
        let integers = [3, 1, 4, 15, 9, 2, 6, 5];
        (0..256_u32).map(|bits| lanes.pack(&integers, bits)[..bits.count_ones() as usize].to_vec()).collect()
    }
}

#[test]
fn whole_numbers_are_packed_by_bits() {
    let integers = [3, 1, 4, 15, 9, 2, 6, 5];
    let wanted = |bits: u32| (0..8).filter(move |lane| bits >> lane & 1 == 1).map(|lane| integers[lane]).collect();
    let expected: Vec<Vec<u32>> = (0..256).map(wanted).collect();
    for path in Processor::all() {
        assert_eq!(path.run(PackedIntegers), expected, "{}", path.name());
    }
}

/// The portable backend gives the same results with four lanes as with one.
#[test]
fn four_portable_lanes_are_four_numbers() {
    let [mut one, mut four] = [Vec::new(), Vec::new()];
    AllPairBits(&mut one).run(ScalarBackend::<1>);
    AllPairBits(&mut four).run(ScalarBackend::<4>);
    assert!(one == four);
    let table = [1.0, 5.0, 9.0, 13.0].map(|from| Quad([from, from + 1.0, from + 2.0, from + 3.0]));
    let at = [2, 0, 3, 1];
    assert_eq!(QuadCopies(&table, &at).run(ScalarBackend::<4>), QuadCopies(&table, &at).run(ScalarBackend::<1>));
}

/// Kernel that adds two quads per lane to given quads, and then applies `oppose`.
struct Pairs<'a>(&'a [Quad], &'a [usize]);

impl Kernel for Pairs<'_> {
    type Output = Vec<[Quad; 2]>;

    fn run<L: Lanes>(self, lanes: L) -> Self::Output {
        let mut all = Vec::new();
        for at in self.1.chunks(L::WIDTH) {
            let (mut one, mut other) = ([0; WIDEST], [0; WIDEST]);
            one[..at.len()].copy_from_slice(at);
            other[..at.len()].copy_from_slice(&at.iter().map(|place| 19 - place).collect::<Vec<_>>());
            let table = self.0.as_chunks::<1>().0;
            let pairs = lanes.pairs([lanes.gather(table, 0, &one), lanes.gather(table, 0, &other)]);
            for &pair in &pairs[..at.len()] {
                let mut sums = [Quad([1.0, 2.0, 3.0, 4.0]), Quad([5.0, 6.0, 7.0, 8.0])];
                lanes.add_to(&mut sums, pair);
                all.push(sums);
                lanes.oppose(&mut sums, pair);
                all.push(sums);
            }
        }
        all
    }
}

#[test]
fn two_quads_of_each_lane_are_added_together() {
    let table: Vec<Quad> = (0..20).map(|row| Quad([0.0, 0.1, 0.2, 0.3].map(|at| f64::from(row) + at))).collect();
    let at = [3, 19, 0, 7, 7, 11, 2, 5, 18, 1, 4, 9, 9, 9, 16, 0];
    let expected_pair = |&at: &usize| {
        let mut sums = [Quad([1.0, 2.0, 3.0, 4.0]), Quad([5.0, 6.0, 7.0, 8.0])];
        sums[0].add(&table[at]);
        sums[1].add(&table[19 - at]);
        let added = sums;
        sums[0].subtract(&table[at]);
        sums[1].add(&table[19 - at]);
        [added, sums]
    };
    let expected: Vec<_> = at.iter().flat_map(expected_pair).collect();
    for path in Processor::all() {
        assert_eq!(path.run(Pairs(&table, &at)), expected, "{}", path.name());
    }
}
