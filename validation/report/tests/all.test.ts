import './format.test';
import './plot_data.test';
import './report.test';
import './verdict.test';
