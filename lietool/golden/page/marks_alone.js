// What a page without pictures needs of the viewer.
const one = (selector) => document.querySelector(selector), root = document.documentElement;
