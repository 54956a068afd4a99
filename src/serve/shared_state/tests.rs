use super::welcome_line;

#[test]
fn the_link_has_room_beside_the_keys() {
    let link = "https://example.org/demo";
    assert_eq!(welcome_line(1, None, 80), "drag or WASD moves, t turns, ? all keys, q quits");
    assert_eq!(welcome_line(2, Some(link), 80), format!("? all keys, q quits  {link}"));
    let wide = format!("drag or WASD moves, t turns, n next scene, ? all keys, q quits  {link}");
    assert_eq!(welcome_line(2, Some(link), 90), wide);
}
