use super::*;
use std::net::{Ipv4Addr, Ipv6Addr};

fn v4(last: u32) -> IpAddr {
    IpAddr::V4(Ipv4Addr::from(0x0a00_0000 + last))
}

const SECOND: Duration = Duration::from_secs(1);

#[test]
fn an_address_has_a_limit_of_its_own() {
    let mut limiter = ConnectionLimiter::new(100, 3);
    let mut entries: Vec<_> = (0..3).map(|_| limiter.enter(v4(1), Duration::ZERO).expect("within the limit")).collect();
    assert_eq!(limiter.enter(v4(1), Duration::ZERO).unwrap_err(), Refusal::Address);
    assert!(limiter.enter(v4(2), Duration::ZERO).is_ok());
    limiter.leave(entries.pop().unwrap());
    assert!(limiter.enter(v4(1), Duration::ZERO).is_ok());
}

#[test]
fn a_network_of_ipv6_is_one_address() {
    let mut limiter = ConnectionLimiter::new(100, 2);
    let address = |last| IpAddr::V6(Ipv6Addr::new(0x2001, 0xdb8, 0, 1, last, 0, 0, 1));
    assert!(limiter.enter(address(1), Duration::ZERO).is_ok() && limiter.enter(address(2), Duration::ZERO).is_ok());
    assert_eq!(limiter.enter(address(3), Duration::ZERO).unwrap_err(), Refusal::Address);
    // An IPv4 address in IPv6 form counts as the IPv4 address.
    let mapped = IpAddr::V6(Ipv4Addr::new(10, 0, 0, 9).to_ipv6_mapped());
    assert!(limiter.enter(mapped, Duration::ZERO).is_ok() && limiter.enter(v4(9), Duration::ZERO).is_ok());
    assert!(limiter.enter(v4(9), Duration::ZERO).is_err());
}

#[test]
fn silent_connections_leave_room_for_others() {
    let mut limiter = ConnectionLimiter::new(1000, 10);
    let silent: Vec<_> = (0..500).filter_map(|_| limiter.enter(v4(1), Duration::ZERO).ok()).collect();
    assert_eq!(silent.len(), MAX_LOGGING_IN_PER_ADDRESS);
    let mut good = limiter.enter(v4(2), Duration::ZERO).expect("another address");
    limiter.log_in(&mut good);
    limiter.log_in(&mut good);
    for address in 3..100 {
        let _ = limiter.enter(v4(address), Duration::ZERO);
    }
    assert_eq!(
        (limiter.logging_in, limiter.enter(v4(200), Duration::ZERO).unwrap_err()),
        (MAX_LOGGING_IN, Refusal::Busy)
    );
    for entry in silent {
        limiter.leave(entry);
    }
    assert!(limiter.enter(v4(200), Duration::ZERO).is_ok());
}

#[test]
fn a_storm_from_one_address_is_slowed_down() {
    let mut limiter = ConnectionLimiter::new(1000, 10);
    let mut admitted = 0;
    for step in 0..1000 {
        if let Ok(entry) = limiter.enter(v4(1), SECOND * step / 1000) {
            admitted += 1;
            limiter.leave(entry);
        }
    }
    assert!((BURST as usize..=BURST as usize + 6).contains(&admitted), "{admitted}");
}

#[test]
fn the_table_is_bounded() {
    let mut limiter = ConnectionLimiter::new(1_000_000, 10);
    for address in 0..50_000 {
        if let Ok(entry) = limiter.enter(v4(address), Duration::ZERO) {
            limiter.leave(entry);
        }
    }
    assert_eq!(limiter.origins.len(), MAX_REMEMBERED + 1);
    // A minute later, all addresses without connections are forgotten.
    assert!(limiter.enter(v4(60_000), 60 * SECOND).is_ok());
    assert!(limiter.origins.len() < 10);
}

#[test]
fn places_are_given_in_the_order_of_arrival() {
    let mut places = Places::new(2);
    let [first, second, third, fourth] = [(); 4].map(|()| places.join().expect("there is room"));
    assert_eq!((places.take(first), places.take(third)), (Ok(()), Err(1)));
    assert_eq!((places.take(second), places.take(third), places.take(fourth)), (Ok(()), Err(0), Err(1)));
    places.free();
    assert_eq!((places.take(fourth), places.take(third)), (Err(1), Ok(())));
    places.give_up(fourth);
    assert!(places.waiting.is_empty());
    assert_eq!((0..100).filter_map(|_| places.join()).count(), 16);
}
