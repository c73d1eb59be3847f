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

/// Two quads, to which others are added.
const SUMS: [Quad; 2] = [Quad([1.0, 2.0, 3.0, 4.0]), Quad([5.0, 6.0, 7.0, 8.0])];

/// Kernel that combines the quads of a table at some indices with the quads at the same indices from the end. Each row
/// holds a quad that was loaded into registers, the same quad after its return from them, and the difference. Then follow
/// the two quads of `SUMS` with the pair added, and after `oppose`.
struct QuadOperations<'a>(&'a [Quad], &'a [usize]);

impl Kernel for QuadOperations<'_> {
    type Output = Vec<[Quad; 7]>;

    fn run<L: Lanes>(self, lanes: L) -> Self::Output {
        let (table, mut rows) = (self.0.as_chunks::<1>().0, Vec::new());
        for at in self.1.chunks(L::WIDTH) {
            let [mut from, mut to] = [[0; WIDEST]; 2];
            at.iter().enumerate().for_each(|(lane, &place)| (from[lane], to[lane]) = (place, table.len() - 1 - place));
            let registers = lanes.gather(table, 0, &from);
            let columns = [registers, lanes.between(table, 0, &from, &to)].map(|all| all.map(|one| lanes.store(one)));
            let (back, pairs) = (lanes.quads(registers), lanes.pairs([registers, lanes.gather(table, 0, &to)]));
            for lane in 0..at.len() {
                let [gathered, difference] = columns.map(|columns| Quad(columns.map(|column| column[lane])));
                let mut sums = SUMS;
                lanes.add_to(&mut sums, pairs[lane]);
                let added = sums;
                lanes.oppose(&mut sums, pairs[lane]);
                rows.push([gathered, back[lane], difference, added[0], added[1], sums[0], sums[1]]);
            }
        }
        rows
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
fn quads_are_loaded_subtracted_and_added_on_all_paths() {
    let table: Vec<Quad> = (0..20).map(|row| Quad([0.0, 0.1, 0.2, 0.3].map(|at| f64::from(row) + at))).collect();
    let at = [3, 19, 0, 7, 7, 11, 2, 5, 18, 1, 4, 9, 9, 9, 16, 0];
    let expected_row = |&at: &usize| {
        let [one, other] = [table[at], table[19 - at]];
        let [from, to] = [one.0, other.0];
        let difference = Quad([to[0] - from[0], to[1] - from[1], to[2] - from[2], to[3] + from[3]]);
        let mut sums = SUMS;
        sums[0].add(&one);
        sums[1].add(&other);
        let added = sums;
        sums[0].subtract(&one);
        sums[1].add(&other);
        [one, one, difference, added[0], added[1], sums[0], sums[1]]
    };
    let expected: Vec<_> = at.iter().map(expected_row).collect();
    for path in Processor::all() {
        assert_eq!(path.run(QuadOperations(&table, &at)), expected, "{}", path.name());
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
    let operations = || QuadOperations(&table, &at);
    assert_eq!(operations().run(ScalarBackend::<4>), operations().run(ScalarBackend::<1>));
}
